#include "services/vehicle_node/vehicle_join.h"

#include <algorithm>
#include <chrono>

namespace giveway {
namespace {

constexpr Nanoseconds kPoll = std::chrono::milliseconds(20);
constexpr Nanoseconds kAskAgain =
    std::chrono::seconds(1);  // who waits and does not ask is forgotten
constexpr Nanoseconds kReminder = std::chrono::seconds(5);

}  // namespace

Asking::Asking(link::VehicleLink* link, VehicleId wanted, const std::optional<SessionId>& session)
    : link_(*link) {
  request_.wanted = wanted;
  if (session) {
    request_.session = *session;
  } else {
    for (std::uint32_t& word : request_.session) word = RandomNonZero();
  }
  Ask();
}

void Asking::AskAgainIfDue() {
  if (SteadyNow() >= again_) Ask();
}

bool Asking::IsFinal(const RosterEntry& entry) {
  answered_ = true;
  if (!entry.accepted && entry.waiting) {
    waits_for_ = "the world lets it wait: " + entry.reason;
    LogWarning(waits_for_);
  }
  return entry.accepted || !entry.waiting;
}

void Asking::Ask() {
  link_.SendJoin(request_);
  again_ = SteadyNow() + kAskAgain;
}

VehicleOptions OptionsOf(const Scenario& scenario, const RosterEntry& entry) {
  const auto& known = entry.spawn == 0 ? scenario.vehicles : scenario.spawns;
  const auto found = entry.spawn == 0 ? std::ranges::find(known, entry.vehicle, &VehicleOptions::id)
                                      : known.begin() + std::min<std::ptrdiff_t>(entry.spawn - 1,
                                                                                 std::ssize(known));
  if (found == known.end()) {
    throw link::LinkError("the world gave this vehicle a place its scenario does not have: id " +
                          std::to_string(Number(entry.vehicle)) +
                          (entry.spawn == 0 ? "" : ", spawn " + std::to_string(entry.spawn)) +
                          "; start both with the same scenario file");
  }
  VehicleOptions options = *found;
  options.id = entry.vehicle;
  options.start_world = entry.start_world;
  return options;
}

std::optional<RosterEntry> Join(link::VehicleLink* link, const StopSignal& stop, VehicleId wanted,
                                const std::optional<SessionId>& session,
                                VehicleHealthTeller* health) {
  Asking asking(link, wanted, session);
  SteadyTime remind = SteadyNow() + kReminder;
  while (!stop.IsSet()) {
    const auto entry = link->TakeRoster(asking.Session());
    if (entry && asking.IsFinal(*entry)) return entry;
    asking.AskAgainIfDue();
    const std::string& answer = asking.WaitsFor();
    health->Joins(answer.empty() ? link->WhyNobodyIsFound() : answer);
    SleepUntil(SteadyNow() + kPoll);
    if (SteadyNow() < remind) continue;
    remind += kReminder;
    const std::string change = link->InterfaceChange();
    if (!change.empty()) throw link::LinkError(change + "; ends, to be started again");
    if (asking.Answered()) continue;
    const std::string no_servers = link->WhyNobodyIsFound();
    LogWarning(!no_servers.empty()
                   ? no_servers
                   : "no answer from a world yet: is giveway-world running in this domain?");
  }
  link->SendLeave(asking.Session());
  return std::nullopt;
}

}  // namespace giveway
