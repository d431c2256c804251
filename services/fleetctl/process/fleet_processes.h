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
  bool planned = false;  // as by Kill or Plan
};

struct MemberLine {
  MemberId member;
  std::string text;
};

// An unknown member is a bug of the caller.
class FleetProcesses {
 public:
  // Starts the processes that are due at once; Poll starts the others. Use on one thread, which
  // must outlive this: see ChildProcess. Throws StartError, as Poll and Restart do.
  explicit FleetProcesses(std::vector<MemberCommand> commands);

  // Never blocks.
  void Poll();

  // No effect on processes that do not run.
  void Signal(MemberId member, int signal_number);
  void SignalAll(int signal_number);
  // From now on an end of exactly this kind is planned, but not one that has already happened.
  void Plan(MemberId member, ProcessEnd how);
  // SIGKILL, as a planned end.
  void Kill(MemberId member);
  // Another process for one that has ended, which is forgotten: with the same command line, or
  // another. It has a log of its own.
  void Restart(MemberId member);
  void Restart(MemberCommand command);
  // Whether the output of its process is read; on at the start.
  void HearLog(MemberId member, bool hear);
  // Of its process, running or not; nothing before the first.
  OutputFlow OutputOf(MemberId member) const;
  // SIGTERM, once per process, and SIGCONT for processes that were paused by Signal.
  void AskToStop(MemberId member);
  // The same, or SIGKILL, for all. Nothing more is started afterwards.
  void AskToStop();
  void ForceEnd();
  // Calls `turn`, which polls, until all have ended; at most for `grace`, and no longer once the
  // operator has interrupted twice. True if all have ended.
  bool WaitUntilEnded(Nanoseconds grace, const std::function<void()>& turn) const;
  // Asks all to stop, and kills those that do not within `grace`. Returns when all have ended.
  void EndAll(Nanoseconds grace, const std::function<void()>& turn);

  bool IsRunning(MemberId member) const { return At(member).IsRunning(); }
  bool AnyRunning(const std::function<bool(MemberId)>& of) const;
  bool AllEnded() const;  // and no start is pending
  // As it was started last.
  const MemberCommand& CommandOf(MemberId member) const { return At(member).command; }
  // The end of its process, once it is known.
  const std::optional<MemberEnd>& EndOf(MemberId member) const { return At(member).end; }
  // The first disallowed end, in the order of the commands.
  std::optional<MemberEnd> FirstEndNotAllowed(
      const std::function<bool(const MemberEnd&)>& may_end) const;
  // Since the last call.
  std::vector<MemberEnd> TakeEnds();
  // Output lines since the last call, if the commands ask for them.
  std::vector<MemberLine> TakeLines();
  // Of all logs since the last call, see ChildLog.
  std::vector<std::string> TakeLogComplaints();
  // Of its process, oldest first.
  const std::deque<std::string>& LastLines(MemberId member) const;
  // For prlimit and the like. nullopt unless it is running: the id may have been reused.
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
  void PollThoseWithNews();

  std::vector<Member> members_;
  SteadyTime begun_;
  bool stopping_ = false;
};

}  // namespace giveway::fleetctl
