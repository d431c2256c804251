#include "services/fleetctl/qos/qos_apply_fleet.h"

#include <algorithm>
#include <chrono>

#include "services/fleetctl/process/interrupts.h"
#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr auto kFindPatience = seconds(10);
constexpr auto kTellPatience = seconds(5);
constexpr auto kQuiet = milliseconds(1500);          // announcements come every second
constexpr auto kQuietOfTheRest = milliseconds(400);  // heard since the targets were sought
constexpr auto kAskTurn = milliseconds(20);

// All vehicles, and the world if there is one, when no new one has appeared for `patience`;
// `insist`: and there is at least one.
std::vector<VehicleId> Everyone(Orders* orders, milliseconds patience, bool insist,
                                FleetAnswers* fleet) {
  const SteadyTime end = SteadyNow() + kFindPatience;
  SteadyTime quiet = SteadyNow() + patience;
  std::vector<VehicleId> found;
  while (SteadyNow() < end && SteadyNow() < quiet && Interrupts::Count() == 0) {
    SleepUntil(SteadyNow() + kAskTurn);
    std::vector<VehicleId> now = orders->Announced();
    if (now.size() != found.size() || (insist && now.empty())) quiet = SteadyNow() + patience;
    found = std::move(now);
  }
  found.push_back(kNobody);
  const std::vector<VehicleId> missing = orders->Seek(found, patience);
  const auto is_missing = [&](VehicleId process) {
    return std::ranges::find(missing, process) != missing.end();
  };
  std::erase_if(found, is_missing);
  fleet->deaf = missing;
  std::erase(fleet->deaf, kNobody);
  return found;
}

int FindTargets(const QosApplyOptions& options, Orders* orders, FleetAnswers* fleet) {
  const VehicleId canary{options.canary};
  for (const std::uint32_t id : options.to) fleet->targets.push_back(VehicleId{id});
  if (options.all) {
    fleet->targets = Everyone(orders, kQuiet, true, fleet);
    if (fleet->targets.empty()) return SayNobodyReached(options.where.domain);
  }
  int code = 0;
  for (const VehicleId vehicle : orders->Seek(fleet->targets, kFindPatience)) {
    code = SayNotReached(vehicle, options.where.domain);
  }
  if (code != 0 || options.canary == 0) return code;
  const auto first = std::ranges::find(fleet->targets, canary);
  if (first == fleet->targets.end()) return SayNotReached(canary, options.where.domain);
  std::rotate(fleet->targets.begin(), first, first + 1);
  return 0;
}

}  // namespace

int AskFleet(const QosApplyOptions& options, Orders* orders, FleetAnswers* fleet) {
  if (const int code = FindTargets(options, orders, fleet); code != 0) return code;
  for (const VehicleId process : fleet->targets) {
    auto answer = orders->Give(TellOrder(process), kTellPatience);
    if (!answer) return SayNoAnswer(process);
    if (answer->state == AnswerState::kRefused) return SayRefused(*answer);
    fleet->told.emplace(process, std::move(*answer));
  }
  // A process that keeps its QoS must still receive the others. Those that do not answer are left
  // out.
  for (const VehicleId process : Everyone(orders, kQuietOfTheRest, false, fleet)) {
    if (fleet->told.contains(process)) continue;
    auto answer = orders->Give(TellOrder(process), kTellPatience);
    if (!answer) continue;
    if (answer->state == AnswerState::kRefused) {
      fleet->deaf.push_back(process);
    } else {
      fleet->told.emplace(process, std::move(*answer));
    }
  }
  return 0;
}

}  // namespace giveway::fleetctl
