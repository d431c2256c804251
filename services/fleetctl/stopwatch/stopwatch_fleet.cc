#include "services/fleetctl/stopwatch/stopwatch_fleet.h"

#include <algorithm>
#include <cstdio>

#include "services/config/scenario_file.h"
#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

// A report has its own time: reading it a little later loses nothing.
constexpr Nanoseconds kTurn = std::chrono::milliseconds(10);
constexpr Nanoseconds kGrace = std::chrono::seconds(2);

std::vector<MemberCommand> CommandsOf(FleetSpec spec, const DomainLock& lock,
                                      const std::map<VehicleId, std::string>& impair) {
  spec.domain = lock.Domain();
  spec.lock_fd = lock.Fd();
  spec.hands_on_lines = true;
  for (const auto& [vehicle, rules] : impair) {
    auto& words = spec.extra_words[MemberOf(vehicle)];
    words = {"--log-format", "json", "--hang-on-signal", "--no-watchdog"};
    if (!rules.empty()) words.insert(words.end(), {"--impair", rules});
  }
  return MakeCommands(spec, LoadScenario(spec.scenario_file, {}));
}

}  // namespace

StopwatchFleet::StopwatchFleet(const FleetSpec& spec,
                               const std::map<VehicleId, std::string>& impair)
    : lock_(std::nullopt), processes_(CommandsOf(spec, lock_, impair)) {}

StopwatchFleet::~StopwatchFleet() {
  processes_.EndAll(kGrace, [this] { Turn(); });
}

void StopwatchFleet::Turn() {
  SleepUntil(SteadyNow() + kTurn);
  processes_.Poll();
  for (const auto& [member, line] : processes_.TakeLines()) {
    const std::optional<LogEvent> event = member == kTheWorld ? std::nullopt : LogEventOf(line);
    if (!event) continue;
    const VehicleId vehicle{member.number};
    if (event->kind == LogEventKind::kBlackoutsCount) blackouts_since_[vehicle] = event->at;
    hearing_.Fold(vehicle, *event);
    events_.push_back({vehicle, *event});
  }
  for (const std::string& complaint : processes_.TakeLogComplaints()) {
    std::fprintf(stderr, "%s\n", complaint.c_str());
  }
}

std::optional<SteadyTime> StopwatchFleet::BlackoutsSince(VehicleId vehicle) const {
  const auto since = blackouts_since_.find(vehicle);
  if (since == blackouts_since_.end()) return std::nullopt;
  return since->second;
}

void StopwatchFleet::Restart(VehicleId vehicle) {
  hearing_.Restart(vehicle);
  processes_.Restart(MemberOf(vehicle));
}

std::optional<std::string> StopwatchFleet::Loss(std::span<const VehicleId> injected) const {
  const auto gone = processes_.FirstEndNotAllowed([injected](const MemberEnd& end) {
    return std::ranges::any_of(injected, [&](VehicleId id) { return MemberOf(id) == end.member; });
  });
  if (!gone) return std::nullopt;
  std::string text = NameOf(gone->member) + " ended unasked: " + Describe(gone->how);
  for (const std::string& line : processes_.LastLines(gone->member)) text += "\n  " + line;
  return text;
}

}  // namespace giveway::fleetctl
