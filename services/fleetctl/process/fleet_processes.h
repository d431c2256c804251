// The processes of one fleet: starts, polls, signals, restarts, measures and ends them, and
// distinguishes planned exits from others. The caller decides which exits are allowed. Knows no
// DDS.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/process/fleet_commands.h"
#include "services/fleetctl/process/process_resources.h"

namespace giveway::fleetctl {

struct MemberEnd {
  MemberId member;
  ProcessEnd how;
  bool planned = false;  // as Kill or Plan had it
};

struct MemberLine {
  MemberId member;
  std::string text;
};

// A member that is not of the fleet is our bug.
class FleetProcesses {
 public:
  // Starts those that are due at once; Poll starts the others. Everything on one thread, which must
  // outlive this: see ChildProcess. Throws StartError, as Poll and Restart do.
  explicit FleetProcesses(std::vector<MemberCommand> commands);

  // Never blocks.
  void Poll();

  // Nothing happens to what is not running.
  void Signal(MemberId member, int signal_number);
  void SignalAll(int signal_number);
  // From now on an end of just this kind is planned. Not one that has come already.
  void Plan(MemberId member, ProcessEnd how);
  // SIGKILL, as planned.
  void Kill(MemberId member);
  // Another process for one that has ended, which is forgotten: with the same words, or others. It
  // has a log of its own.
  void Restart(MemberId member);
  void Restart(MemberCommand command);
  // Whether the output of its process is read. As it starts, it is.
  void HearLog(MemberId member, bool hear);
  // SIGTERM, once a process, and SIGCONT for those that were paused by Signal.
  void AskToStop(MemberId member);
  // That, or SIGKILL, for all. Nothing more is started then.
  void AskToStop();
  void ForceEnd();
  // Calls `turn`, which polls, until all have ended; at most for `grace`, and no longer once the
  // operator has interrupted twice. True if all have ended.
  bool WaitUntilEnded(Nanoseconds grace, const std::function<void()>& turn) const;
  // Asks all to stop, and kills those that do not within `grace`. Returns when all have ended.
  void EndAll(Nanoseconds grace, const std::function<void()>& turn);

  bool IsRunning(MemberId member) const { return At(member).IsRunning(); }
  bool AnyRunning(const std::function<bool(MemberId)>& of) const;
  bool AllEnded() const;  // and none is still to be started
  // Its process's, once it is known to have ended.
  const std::optional<MemberEnd>& EndOf(MemberId member) const { return At(member).end; }
  // Of those that have ended, the first in the order of the commands that may not.
  std::optional<MemberEnd> FirstEndNotAllowed(
      const std::function<bool(const MemberEnd&)>& may_end) const;
  // Since the last call.
  std::vector<MemberEnd> TakeEnds();
  // Said since the last call, where the commands ask for that.
  std::vector<MemberLine> TakeLines();
  // Of its process, oldest first.
  const std::deque<std::string>& LastLines(MemberId member) const;
  // For prlimit and the like. Nothing unless it is running: the id may be another's by now.
  std::optional<pid_t> PidOf(MemberId member) const;
  std::optional<ProcessResources> ResourcesOf(MemberId member) const;

 private:
  struct Member {
    MemberCommand command;
    std::unique_ptr<ChildProcess> process;  // none: the start is not due yet
    unsigned restarts = 0;
    std::optional<ProcessEnd> plan;
    std::optional<MemberEnd> end;
    bool end_taken = false;
    bool paused = false;

    bool IsRunning() const { return process && process->IsRunning(); }
    void Start();
    void Poll();
    void Signal(int signal_number);
    void AskToStop();
  };

  const Member& At(MemberId member) const;
  Member& At(MemberId member);

  std::vector<Member> members_;
  SteadyTime begun_;
  bool stopping_ = false;
};

}  // namespace giveway::fleetctl
