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
constexpr auto kReportPatience = seconds(5);
constexpr auto kQuiet = milliseconds(1500);          // announcements come every second
constexpr auto kQuietOfTheRest = milliseconds(400);  // heard since the targets were sought
constexpr auto kAskTurn = milliseconds(20);

// All vehicles, and the world if there is one, when no new one has appeared for `patience`;
// `insist`: and there is at least one.
std::vector<VehicleId> Everyone(AdminClient* client, milliseconds patience, bool insist,
                                FleetAnswers* fleet) {
  const SteadyTime end = SteadyNow() + kFindPatience;
  SteadyTime quiet = SteadyNow() + patience;
  std::vector<VehicleId> found;
  while (SteadyNow() < end && SteadyNow() < quiet && Interrupts::Count() == 0) {
    SleepUntil(SteadyNow() + kAskTurn);
    std::vector<VehicleId> now = client->Announced();
    if (now.size() != found.size() || (insist && now.empty())) quiet = SteadyNow() + patience;
    found = std::move(now);
  }
  found.push_back(kNoVehicle);
  const std::vector<VehicleId> missing = client->Seek(found, patience);
  const auto is_missing = [&](VehicleId process) {
    return std::ranges::find(missing, process) != missing.end();
  };
  std::erase_if(found, is_missing);
  fleet->not_administrable = missing;
  std::erase(fleet->not_administrable, kNoVehicle);
  return found;
}

int FindTargets(const QosApplyOptions& options, AdminClient* client, FleetAnswers* fleet) {
  const VehicleId canary{options.canary};
  for (const std::uint32_t id : options.to) fleet->targets.push_back(VehicleId{id});
  if (options.all) {
    fleet->targets = Everyone(client, kQuiet, true, fleet);
    if (fleet->targets.empty()) return ReportNoneReached(options.where.domain);
  }
  int code = 0;
  for (const VehicleId vehicle : client->Seek(fleet->targets, kFindPatience)) {
    code = ReportNotReached(vehicle, options.where.domain);
  }
  if (code != 0 || options.canary == 0) return code;
  const auto first = std::ranges::find(fleet->targets, canary);
  if (first == fleet->targets.end()) return ReportNotReached(canary, options.where.domain);
  std::rotate(fleet->targets.begin(), first, first + 1);
  return 0;
}

}  // namespace

int AskFleet(const QosApplyOptions& options, AdminClient* client, FleetAnswers* fleet) {
  if (const int code = FindTargets(options, client, fleet); code != 0) return code;
  for (const VehicleId process : fleet->targets) {
    auto answer = client->Send(QosReportRequest(process), kReportPatience);
    if (!answer) return ReportNoAnswer(process);
    if (answer->state == AnswerState::kRefused) return ReportRefused(*answer);
    fleet->answers.emplace(process, std::move(*answer));
  }
  // A process that keeps its QoS must still receive the others. Those that do not answer are left
  // out.
  for (const VehicleId process : Everyone(client, kQuietOfTheRest, false, fleet)) {
    if (fleet->answers.contains(process)) continue;
    auto answer = client->Send(QosReportRequest(process), kReportPatience);
    if (!answer) continue;
    if (answer->state == AnswerState::kRefused) {
      fleet->not_administrable.push_back(process);
    } else {
      fleet->answers.emplace(process, std::move(*answer));
    }
  }
  return 0;
}

}  // namespace giveway::fleetctl
