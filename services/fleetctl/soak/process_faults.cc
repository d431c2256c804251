#include "services/fleetctl/soak/process_faults.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <iterator>

#include "services/fleetctl/args/qos_files.h"
#include "services/runtime/hang_signal.h"
#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

using faults::Kind;
using faults::Target;
using std::chrono::milliseconds;

constexpr Nanoseconds kChurnLife =
    milliseconds(1500);  // of each process that is started and killed
constexpr std::uint32_t kFirstChurnId = 1'000'000;

// Removes a flag and its value.
void DropFlag(std::vector<std::string>* words, const std::string& flag) {
  const auto found = std::ranges::find(*words, flag);
  if (found != words->end()) words->erase(found, std::next(found, 2));
}

// The third field of proc_pid_stat(5), after the name in parentheses: T if it is stopped.
bool IsStopped(pid_t pid) {
  std::ifstream stat(fmt::format("/proc/{}/stat", pid));
  std::string text;
  std::getline(stat, text);
  const std::size_t name_end = text.rfind(')');
  return name_end != std::string::npos && name_end + 2 < text.size() && text[name_end + 2] == 'T';
}

// Of proc(5): address space in bytes, from the first field of statm.
std::uint64_t AddressSpaceOf(pid_t pid) {
  std::ifstream statm(fmt::format("/proc/{}/statm", pid));
  std::uint64_t pages = 0;
  statm >> pages;
  return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

// `fleetctl qos apply` with the flags of every order to this fleet.
std::vector<std::string> VerbOf(const FaultTools& tools) {
  std::vector<std::string> words = {tools.fleetctl, "qos", "apply", "--domain",
                                    std::to_string(tools.domain)};
  const auto add = [&](const char* flag, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {flag, value});
  };
  add("--interface", tools.interface);
  add("--discovery-server", tools.discovery_servers);
  add("--admin-key", tools.admin_key);
  return words;
}

}  // namespace

void SetFlag(std::vector<std::string>* words, const std::string& flag, const std::string& value) {
  const auto found = std::ranges::find(*words, flag);
  if (found != words->end() && std::next(found) != words->end()) {
    *std::next(found) = value;
  } else {
    words->push_back(flag);
    words->push_back(value);
  }
}

ProcessFaults::ProcessFaults(FaultTools tools, FleetProcesses* processes)
    : tools_(std::move(tools)), processes_(processes), orders_(VerbOf(tools_), tools_.qos_file) {}

const char* ProcessFaults::WhyNot(const faults::Fault& fault, bool has_discovery_servers) {
  constexpr const char* kNoServer = "it takes --discovery-servers: there is none in this fleet";
  const bool world = fault.target.what == Target::What::kWorld;
  const bool vehicles =
      fault.target.what == Target::What::kVehicle || fault.target.what == Target::What::kAll;
  switch (fault.kind) {
    case Kind::kKill:
    case Kind::kRestart:
    case Kind::kPause:
    case Kind::kSlow:
    case Kind::kMemoryLimit:
    case Kind::kDescriptorLimit:
    case Kind::kLogReaderStops:
      return world || vehicles || has_discovery_servers ? nullptr : kNoServer;
    case Kind::kHang:
    case Kind::kDiskFull:
    case Kind::kQosMismatch:
    case Kind::kQosApply:
    case Kind::kDuplicateId:
      return vehicles ? nullptr : "only vehicles can have this fault";
    case Kind::kChurn:
      return nullptr;
    case Kind::kClockStep:
      if (fault.target.what == Target::What::kDiscoveryServer) break;
      return ClockStepLibrary().empty()
                 ? "lib/giveway/libgiveway-clock-step.so is not there, next to bin"
                 : nullptr;
    case Kind::kSharedMemoryGone:
    case Kind::kSharedMemoryLeftOver:
    case Kind::kSharedMemorySmall:
      return WhyNoPrivateShm();
    default:
      return "it is not the supervisor's";
  }
  return "no clock of a discovery server is stepped";
}

std::vector<MemberId> ProcessFaults::MembersOf(const Target& target) const {
  switch (target.what) {
    case Target::What::kVehicle:
      return {MemberOf(target.vehicle)};
    case Target::What::kWorld:
      return {kTheWorld};
    case Target::What::kDiscoveryServer:
    case Target::What::kAll:
      break;
  }
  const bool servers = target.what == Target::What::kDiscoveryServer;
  std::vector<MemberId> members;
  for (const MemberCommand& command : tools_.commands) {
    if ((command.member.kind == MemberKind::kDiscoveryServer) == servers) {
      members.push_back(command.member);
    }
  }
  return members;
}

bool ProcessFaults::IsAimedAt(const faults::Fault& fault, MemberId member) const {
  return std::ranges::count(MembersOf(fault.target), member) > 0;
}

const MemberCommand* ProcessFaults::CommandOf(MemberId member) const {
  const auto found = std::ranges::find(tools_.commands, member, &MemberCommand::member);
  return found == tools_.commands.end() ? nullptr : &*found;
}

std::string ProcessFaults::EffectOf(const faults::Fault& fault) const {
  if (const auto shm = shm_effects_.find(&fault); shm != shm_effects_.end()) return shm->second;
  for (const MemberId member : MembersOf(fault.target)) {
    if (CommandOf(member) == nullptr) continue;
    const std::string effect = EffectOn(fault, member);
    if (!effect.empty()) return effect;
  }
  return {};
}

std::string ProcessFaults::EffectAtEndOf(const faults::Fault& fault) const {
  if (fault.kind == Kind::kLogReaderStops) return EffectOf(fault);  // of its last moment too
  const auto churn = churns_.find(&fault);
  if (churn == churns_.end() || churn->second.killed == 0) return {};
  return fmt::format("{} processes came and were killed", churn->second.killed);
}

std::string ProcessFaults::EffectOn(const faults::Fault& fault, MemberId member) const {
  const auto pid = processes_->PidOf(member);
  if (!pid) return {};
  switch (fault.kind) {
    case Kind::kPause:
    case Kind::kSlow:
      return IsStopped(*pid) ? "the process is stopped" : "";
    case Kind::kMemoryLimit:
      return LimitOf(member, RLIMIT_AS);
    case Kind::kDescriptorLimit:
      return LimitOf(member, RLIMIT_NOFILE);
    case Kind::kDiskFull:
      return LimitOf(member, RLIMIT_FSIZE);
    case Kind::kLogReaderStops:
      return unread_.EffectOf(fault, LogOf(member));
    case Kind::kDuplicateId:
      return claims_.EffectOf(fault);
    case Kind::kClockStep:
      return ReadingsMoved(member);
    default:
      return {};
  }
}

LogSeen ProcessFaults::LogOf(MemberId member) const {
  return {processes_->PidOf(member), processes_->OutputOf(member)};
}

std::string ProcessFaults::WhyNothingMet(const faults::Fault& fault) const {
  if (fault.kind == Kind::kDuplicateId) return claims_.WhyNothing(fault);
  if (fault.kind != Kind::kLogReaderStops) return {};
  const std::vector<MemberId> members = MembersOf(fault.target);
  return members.size() == 1 ? unread_.WhyNothing(fault, LogOf(members.front())) : "";
}

std::string ProcessFaults::ReadingsMoved(MemberId member) const {
  const auto clock = tools_.clocks.find(member);
  const auto before = moved_before_.find(member);
  if (clock == tools_.clocks.end() || before == moved_before_.end()) return {};
  const std::uint64_t moved = clock->second.Shifted() - before->second;
  return moved == 0 ? "" : fmt::format("{} of its readings of the system clock were moved", moved);
}

void ProcessFaults::BeginOfSharedMemory(const faults::Fault& fault) {
  std::size_t files = 0;
  switch (fault.kind) {
    case Kind::kSharedMemoryGone:
      files = tools_.shm->DeleteAll();
      if (files > 0) shm_effects_[&fault] = fmt::format("{} files were deleted", files);
      break;
    case Kind::kSharedMemoryLeftOver:
      files = tools_.shm->LeaveOver(fault.parameters.count.value_or(1));
      if (files > 0) shm_effects_[&fault] = fmt::format("{} orphaned segments were made", files);
      break;
    case Kind::kSharedMemorySmall:
      if (tools_.shm->Fill()) shm_effects_[&fault] = "no byte of /dev/shm is free";
      break;
    default:
      break;
  }
}

void ProcessFaults::EndOfSharedMemory(const faults::Fault& fault) {
  if (fault.kind == Kind::kSharedMemoryLeftOver) tools_.shm->RemoveLeftOver();
  if (fault.kind == Kind::kSharedMemorySmall) tools_.shm->Empty();
}

void ProcessFaults::StepClock(MemberId member, double offset_s) {
  const auto clock = tools_.clocks.find(member);
  if (clock == tools_.clocks.end()) return;
  if (offset_s != 0) moved_before_[member] = clock->second.Shifted();
  clock->second.Step(std::llround(offset_s));
}

std::vector<std::size_t> ProcessFaults::KillersOf(MemberId member,
                                                  const faults::Schedule& schedule) const {
  std::vector<std::size_t> killers;
  const auto away = away_.find(member);
  if (away == away_.end() || away->second->kind == Kind::kQosMismatch) return killers;
  for (std::size_t i = 0; i < schedule.size(); ++i) {
    if (&schedule[i] == away->second) killers.push_back(i);
  }
  return killers;
}

bool ProcessFaults::IsAwayForGood(MemberId member) const {
  const auto away = away_.find(member);
  return away != away_.end() && away->second->kind == Kind::kKill;
}

std::vector<const faults::Fault*> ProcessFaults::CutShortBy(const faults::Fault& fault) {
  if (faults::ActorOf(fault.kind) != faults::Actor::kSupervisor) return {};
  return claims_.CutShort(fault);
}

void ProcessFaults::Begin(const faults::Fault& fault) {
  if (fault.kind == Kind::kChurn) {
    churns_[&fault].left = fault.parameters.count.value_or(1);
    return;
  }
  if (fault.kind == Kind::kQosApply) return BeginOrders(fault);
  if (tools_.shm != nullptr) BeginOfSharedMemory(fault);
  for (const MemberId member : MembersOf(fault.target)) BeginOn(fault, member);
}

void ProcessFaults::End(const faults::Fault& fault) {
  churns_.erase(&fault);
  claims_.End(fault, SteadyNow());
  unread_.End(fault);
  orders_.End(fault);
  if (tools_.shm != nullptr) EndOfSharedMemory(fault);
  for (const MemberId member : MembersOf(fault.target)) EndOn(fault, member);
}

void ProcessFaults::BeginOn(const faults::Fault& fault, MemberId member) {
  if (CommandOf(member) == nullptr || !processes_->IsRunning(member)) return;
  const faults::Parameters& with = fault.parameters;
  switch (fault.kind) {
    case Kind::kQosMismatch:
      to_start_.insert(member);
      [[fallthrough]];
    case Kind::kKill:
    case Kind::kRestart:
      away_[member] = &fault;
      processes_->Kill(member);
      break;
    case Kind::kPause:
      processes_->Signal(member, SIGSTOP);
      break;
    case Kind::kHang:
      processes_->Signal(member, HangSignal::kHang);
      break;
    case Kind::kSlow:
      slow_.insert_or_assign(member, Slow{DutyCycle(with.share.value_or(1), SteadyNow())});
      break;
    case Kind::kMemoryLimit:
      if (const auto pid = processes_->PidOf(member)) {
        Lower(member, RLIMIT_AS,
              AddressSpaceOf(*pid) + static_cast<std::uint64_t>(with.bytes.value_or(0)));
      }
      break;
    case Kind::kDescriptorLimit:
      if (const auto resources = processes_->ResourcesOf(member)) {
        Lower(member, RLIMIT_NOFILE, resources->descriptors + with.count.value_or(0));
      }
      break;
    case Kind::kDiskFull:
      Lower(member, RLIMIT_FSIZE, 1);
      break;
    case Kind::kLogReaderStops:
      processes_->HearLog(member, false);
      unread_.Begin(fault, LogOf(member));
      break;
    case Kind::kClockStep:
      StepClock(member, with.offset_s.value_or(0));
      break;
    case Kind::kDuplicateId:
      claims_.Begin(
          fault, StartBeside(member, member.number, fmt::format("double of {}", NameOf(member))));
      break;
    default:
      break;
  }
}

void ProcessFaults::EndOn(const faults::Fault& fault, MemberId member) {
  if (CommandOf(member) == nullptr) return;
  switch (fault.kind) {
    case Kind::kRestart:
    case Kind::kQosMismatch:
      // Nothing was started for a member that was away for another fault.
      if (const auto away = away_.find(member); away != away_.end() && away->second == &fault) {
        if (processes_->IsRunning(member)) processes_->Kill(member);
        away_.erase(away);
        to_start_.erase(member);
        returning_.insert(member);
      }
      break;
    case Kind::kPause:
      processes_->Signal(member, SIGCONT);
      break;
    case Kind::kHang:
      processes_->Signal(member, HangSignal::kResume);
      break;
    case Kind::kSlow:
      if (slow_.erase(member) > 0) processes_->Signal(member, SIGCONT);
      break;
    case Kind::kMemoryLimit:
      Restore(member, RLIMIT_AS);
      break;
    case Kind::kDescriptorLimit:
      Restore(member, RLIMIT_NOFILE);
      break;
    case Kind::kDiskFull:
      Restore(member, RLIMIT_FSIZE);
      break;
    case Kind::kLogReaderStops:
      processes_->HearLog(member, true);
      break;
    case Kind::kClockStep:
      StepClock(member, 0);
      break;
    default:
      break;
  }
}

void ProcessFaults::Turn(SteadyTime now, double time_s) {
  if (!start_signal_ && time_s > 0) start_signal_ = now - FromSeconds(time_s);
  // Gone as planned. One that ends again, in a mismatch too, is restarted like any other.
  for (std::set<MemberId>* const gone : {&to_start_, &returning_}) {
    std::erase_if(*gone, [this](MemberId member) {
      if (!processes_->EndOf(member)) return false;
      StartAgain(member);
      return true;
    });
  }
  for (auto& [member, slow] : slow_) TurnSlow(member, now, &slow);
  for (auto& [fault, churn] : churns_) TurnChurn(now, &churn);
  if (claims_.AreAwaited()) claims_.Turn(now, WorldAnswers());
  orders_.Turn(now);
}

// On a full disk it has no log.
void ProcessFaults::StartAgain(MemberId member) {
  try {
    processes_->Restart(CommandNow(member));
  } catch (const StartError& error) {
    failed_starts_.push_back({member, error.what()});
  }
}

bool ProcessFaults::WorldAnswers() const {
  const auto world = processes_->PidOf(kTheWorld);
  return world && (slow_.contains(kTheWorld) || !IsStopped(*world));
}

MemberCommand ProcessFaults::CommandNow(MemberId member) const {
  MemberCommand command = *CommandOf(member);
  if (member.kind != MemberKind::kVehicle) return command;
  const auto away = away_.find(member);
  if (away != away_.end() && away->second->kind == Kind::kQosMismatch) {
    SetFlag(&command.child.words, "--qos", ResolveQosFile(away->second->parameters.qos));
  }
  // Else the times of its rules would count from when it has joined again.
  if (start_signal_ && std::ranges::count(command.child.words, "--impair") > 0) {
    SetFlag(&command.child.words, "--impair-since", fmt::format("{:.6f}", Seconds(*start_signal_)));
  }
  return command;
}

std::unique_ptr<ChildProcess> ProcessFaults::StartBeside(MemberId member, std::uint32_t id,
                                                         const std::string& name) const {
  ChildCommand child = CommandOf(member)->child;
  child.name = name;
  child.hands_on_lines = false;
  child.environment.clear();  // its clock is not the member's, and what it reads is not counted
  if (!child.log_file.empty()) child.log_file += fmt::format(".extra-{}", id);
  SetFlag(&child.words, "--id", std::to_string(id));
  // It must not overwrite the member's own recording.
  DropFlag(&child.words, "--record");
  DropFlag(&child.words, "--record-split");
  DropFlag(&child.words, "--record-ring");
  return std::make_unique<ChildProcess>(child);
}

// To one that is away nothing is ordered.
void ProcessFaults::BeginOrders(const faults::Fault& fault) {
  const bool all = fault.target.what == Target::What::kAll;
  const MemberId member = MemberOf(fault.target.vehicle);
  if (!all && (CommandOf(member) == nullptr || !processes_->IsRunning(member))) return;
  const std::string& set = fault.parameters.qos;
  orders_.Begin(fault, set == faults::kPatientReaders ? tools_.patient_readers : set,
                all ? "all" : std::to_string(member.number));
}

void ProcessFaults::TurnSlow(MemberId member, SteadyTime now, Slow* slow) {
  const bool stop = slow->duty.IsStoppedFrom(now);
  if (stop == slow->stopped) return;
  slow->stopped = stop;
  processes_->Signal(member, stop ? SIGSTOP : SIGCONT);
}

void ProcessFaults::TurnChurn(SteadyTime now, Churn* churn) {
  if (churn->process) {
    churn->process->Poll();
    if (now < churn->until && churn->process->IsRunning()) return;
    churn->killed += churn->process->IsRunning() ? 1 : 0;
    churn->process.reset();  // kills it
  }
  if (churn->left == 0) return;
  const auto any = std::ranges::find(tools_.commands, MemberKind::kVehicle,
                                     [](const MemberCommand& of) { return of.member.kind; });
  if (any == tools_.commands.end()) return;
  const std::uint32_t id = kFirstChurnId + churned_++;
  --churn->left;
  try {
    churn->process = StartBeside(any->member, id, fmt::format("passer-by {}", id));
    churn->until = now + kChurnLife;
  } catch (const StartError&) {
    churn->process.reset();  // one fewer is counted
  }
}

// The hard limit is never changed.
void ProcessFaults::Lower(MemberId member, int resource, std::uint64_t most) {
  const auto pid = processes_->PidOf(member);
  rlimit limit{};
  const auto which = static_cast<__rlimit_resource>(resource);
  if (!pid || ::prlimit(*pid, which, nullptr, &limit) != 0) return;
  lowered_[{member, resource}] = {*pid, limit.rlim_cur};
  limit.rlim_cur = std::min<rlim_t>(most, limit.rlim_cur);
  ::prlimit(*pid, which, &limit, nullptr);
}

// One that has started again since has its own limits.
void ProcessFaults::Restore(MemberId member, int resource) {
  const auto lowered = lowered_.extract({member, resource});
  if (lowered.empty() || processes_->PidOf(member) != lowered.mapped().pid) return;
  rlimit limit{};
  const auto which = static_cast<__rlimit_resource>(resource);
  if (::prlimit(lowered.mapped().pid, which, nullptr, &limit) != 0) return;
  limit.rlim_cur = lowered.mapped().before;
  ::prlimit(lowered.mapped().pid, which, &limit, nullptr);
}

// Empty if it is not lowered.
std::string ProcessFaults::LimitOf(MemberId member, int resource) const {
  const auto lowered = lowered_.find({member, resource});
  if (lowered == lowered_.end() || processes_->PidOf(member) != lowered->second.pid) return {};
  rlimit limit{};
  const auto which = static_cast<__rlimit_resource>(resource);
  if (::prlimit(lowered->second.pid, which, nullptr, &limit) != 0) return {};
  return limit.rlim_cur < lowered->second.before ? fmt::format("limited to {}", limit.rlim_cur)
                                                 : "";
}

}  // namespace giveway::fleetctl
