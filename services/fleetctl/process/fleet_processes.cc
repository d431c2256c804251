#include "services/fleetctl/process/fleet_processes.h"

#include <poll.h>

#include <algorithm>
#include <csignal>
#include <iterator>
#include <utility>

#include "services/fleetctl/process/interrupts.h"
#include "services/runtime/process.h"
#include "services/types/check.h"

namespace giveway::fleetctl {
namespace {

// "vehicle-2.log", "vehicle-2+.log", "vehicle-2++.log": no process overwrites another's log.
std::string LogFile(const std::string& file, unsigned restarts) {
  constexpr unsigned kMostPluses = 20;  // then a number: file names are limited in length
  if (file.empty() || restarts == 0) return file;
  const std::string mark =
      restarts > kMostPluses ? "+" + std::to_string(restarts) : std::string(restarts, '+');
  const std::filesystem::path path(file);
  return path.parent_path() / (path.stem().string() + mark + path.extension().string());
}

}  // namespace

void FleetProcesses::Member::Start() {
  ChildCommand child = command.child;
  child.log_file = LogFile(child.log_file, restarts);
  process = std::make_unique<ChildProcess>(child);
}

void FleetProcesses::Member::Poll() {
  if (!process || end) return;
  process->Poll();
  if (process->IsRunning()) return;
  end = MemberEnd{command.member, *process->End(), plan == process->End()};
}

void FleetProcesses::Member::Signal(int signal_number) {
  if (!process) return;
  if (signal_number == SIGSTOP || signal_number == SIGCONT) paused = signal_number == SIGSTOP;
  process->Signal(signal_number);
}

void FleetProcesses::Member::AskToStop() {
  if (!process) return;
  if (paused) Signal(SIGCONT);
  process->AskToStop();
}

FleetProcesses::FleetProcesses(std::vector<MemberCommand> commands) : begun_(SteadyNow()) {
  for (MemberCommand& command : commands) members_.push_back({std::move(command)});
  Poll();
}

const FleetProcesses::Member& FleetProcesses::At(MemberId member) const {
  const auto found =
      std::ranges::find(members_, member, [](const Member& other) { return other.command.member; });
  GIVEWAY_CHECK(found != members_.end(), NameOf(member));
  return *found;
}

FleetProcesses::Member& FleetProcesses::At(MemberId member) {
  return const_cast<Member&>(std::as_const(*this).At(member));
}

void FleetProcesses::Poll() {
  const SteadyTime now = SteadyNow();
  for (Member& member : members_) {
    const bool waits = !member.process && !stopping_;
    if (waits && now >= begun_ + member.command.start_after) member.Start();
  }
  PollThoseWithNews();
}

// Two system calls where there are none, instead of two for each process.
void FleetProcesses::PollThoseWithNews() {
  const bool any_has_ended = ChildProcess::AnyHasEnded();
  std::vector<pollfd> outputs;
  for (const Member& member : members_) {
    outputs.push_back({member.IsRunning() ? member.process->OutputDescriptor() : -1, POLLIN, 0});
  }
  ::poll(outputs.data(), outputs.size(), 0);  // leaves out those below 0
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (any_has_ended || outputs[i].revents != 0) members_[i].Poll();
  }
}

void FleetProcesses::Signal(MemberId member, int signal_number) {
  At(member).Signal(signal_number);
}

void FleetProcesses::SignalAll(int signal_number) {
  for (Member& member : members_) member.Signal(signal_number);
}

// A process that is gone already ended otherwise: that end stays unplanned.
void FleetProcesses::Plan(MemberId member, ProcessEnd how) {
  At(member).Poll();
  At(member).plan = how;
}

void FleetProcesses::Kill(MemberId member) {
  Plan(member, {true, SIGKILL});
  Signal(member, SIGKILL);
}

OutputFlow FleetProcesses::OutputOf(MemberId member) const {
  const Member& of = At(member);
  return of.process ? of.process->Output() : OutputFlow{};
}

void FleetProcesses::HearLog(MemberId member, bool hear) {
  if (At(member).process) At(member).process->HearOutput(hear);
}

void FleetProcesses::Restart(MemberId member) { Restart(At(member).command); }

void FleetProcesses::Restart(MemberCommand command) {
  Member& last = At(command.member);
  GIVEWAY_CHECK(last.end.has_value(), NameOf(command.member));
  Member next{std::move(command), nullptr, last.restarts + 1};
  next.Start();
  last = std::move(next);
}

void FleetProcesses::AskToStop(MemberId member) { At(member).AskToStop(); }

void FleetProcesses::AskToStop() {
  stopping_ = true;
  for (Member& member : members_) member.AskToStop();
}

void FleetProcesses::ForceEnd() {
  stopping_ = true;
  SignalAll(SIGKILL);
}

bool FleetProcesses::WaitUntilEnded(Nanoseconds grace, const std::function<void()>& turn) const {
  const SteadyTime limit = SteadyNow() + grace;
  while (!AllEnded() && SteadyNow() < limit && Interrupts::Count() < 2) turn();
  return AllEnded();
}

void FleetProcesses::EndAll(Nanoseconds grace, const std::function<void()>& turn) {
  AskToStop();
  if (WaitUntilEnded(grace, turn)) return;
  ForceEnd();
  while (!AllEnded()) turn();
}

bool FleetProcesses::AllEnded() const {
  return std::ranges::all_of(members_, [this](const Member& member) {
    return member.process ? !member.process->IsRunning() : stopping_;
  });
}

bool FleetProcesses::AnyRunning(const std::function<bool(MemberId)>& of) const {
  return std::ranges::any_of(members_, [&of](const Member& member) {
    return member.IsRunning() && of(member.command.member);
  });
}

std::optional<MemberEnd> FleetProcesses::FirstEndNotAllowed(
    const std::function<bool(const MemberEnd&)>& may_end) const {
  for (const Member& member : members_) {
    if (member.end && !may_end(*member.end)) return member.end;
  }
  return std::nullopt;
}

std::vector<MemberEnd> FleetProcesses::TakeEnds() {
  std::vector<MemberEnd> ends;
  for (Member& member : members_) {
    if (member.end && !std::exchange(member.end_taken, true)) ends.push_back(*member.end);
  }
  return ends;
}

std::vector<MemberLine> FleetProcesses::TakeLines() {
  std::vector<MemberLine> lines;
  for (Member& member : members_) {
    if (!member.process) continue;
    for (std::string& line : member.process->TakeLines()) {
      lines.push_back({member.command.member, std::move(line)});
    }
  }
  return lines;
}

std::vector<std::string> FleetProcesses::TakeLogComplaints() {
  std::vector<std::string> complaints;
  for (Member& member : members_) {
    if (!member.process) continue;
    std::ranges::move(member.process->TakeLogComplaints(), std::back_inserter(complaints));
  }
  return complaints;
}

const std::deque<std::string>& FleetProcesses::LastLines(MemberId member) const {
  static const std::deque<std::string> kNone;
  const Member& found = At(member);
  return found.process ? found.process->LastLines() : kNone;
}

std::optional<pid_t> FleetProcesses::PidOf(MemberId member) const {
  if (!IsRunning(member)) return std::nullopt;
  return At(member).process->Pid();
}

std::optional<ProcessResources> FleetProcesses::ResourcesOf(MemberId member) const {
  const std::optional<pid_t> pid = PidOf(member);
  return pid ? ReadResources(*pid) : std::nullopt;
}

}  // namespace giveway::fleetctl
