#include "services/fleetctl/qos/qos_apply_fleet.h"

#include <algorithm>
#include <chrono>

#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/qos/settling.h"
#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr auto kFindPatience = seconds(10);
constexpr auto kReportPatience = seconds(5);
constexpr auto kAskTurn = milliseconds(20);

// Vehicles announce themselves; then each, and the world, either takes orders or does not.
struct Search {
  Settling::Patience announced;
  Settling::Patience reached;
};
// Announcements come every second. On a network that loses packets one process may be matched two
// seconds after the others. Something must be found.
constexpr Search kOfTargets{
    .announced = {.quiet = milliseconds(1500), .limit = kFindPatience, .at_least = 1},
    .reached = {.quiet = seconds(3), .limit = kFindPatience, .at_least = 1}};
// These have been heard since the targets were sought.
constexpr Search kOfTheRest{.announced = {.quiet = milliseconds(400), .limit = kFindPatience},
                            .reached = {.quiet = milliseconds(400), .limit = kFindPatience}};

// All vehicles that take orders, and the world if there is one.
std::vector<VehicleId> Everyone(AdminClient* client, const Search& search, FleetAnswers* fleet) {
  Settling announcements(search.announced, SteadyNow());
  std::vector<VehicleId> found = client->Announced();
  while (!announcements.Take(found.size(), SteadyNow()) && Interrupts::Count() == 0) {
    SleepUntil(SteadyNow() + kAskTurn);
    found = client->Announced();
  }
  found.push_back(kNoVehicle);
  const std::vector<VehicleId> missing = client->Seek(found, search.reached);
  const auto is_missing = [&](VehicleId process) {
    return std::ranges::find(missing, process) != missing.end();
  };
  std::erase_if(found, is_missing);
  fleet->not_administrable = missing;
  std::erase(fleet->not_administrable, kNoVehicle);
  return found;
}

// 0, or the exit code after a message.
int FindTargets(const QosApplyOptions& options, AdminClient* client, FleetAnswers* fleet) {
  if (options.all) fleet->targets = Everyone(client, kOfTargets, fleet);
  if (options.all && fleet->targets.empty()) return ReportNoneReached(options.where.domain);
  std::vector<VehicleId> named;
  for (const std::uint32_t id : options.to) named.push_back(VehicleId{id});
  if (options.all && options.canary != 0) named.push_back(VehicleId{options.canary});
  int code = 0;
  for (const VehicleId vehicle : client->Seek(named, kFindPatience)) {
    code = ReportNotReached(vehicle, options.where.domain);
  }
  for (const VehicleId vehicle : named) {
    const auto known = std::ranges::find(fleet->targets, vehicle);
    if (known == fleet->targets.end()) fleet->targets.push_back(vehicle);
  }
  if (code != 0 || options.canary == 0) return code;
  const auto first = std::ranges::find(fleet->targets, VehicleId{options.canary});
  std::rotate(fleet->targets.begin(), first, first + 1);
  return 0;
}

}  // namespace

int AskFleet(const QosApplyOptions& options, AdminClient* client, FleetAnswers* fleet) {
  if (const int code = FindTargets(options, client, fleet); code != 0) return code;
  for (const VehicleId process : fleet->targets) {
    auto answer = client->AskQos(process, kReportPatience);
    if (!answer) return ReportNoAnswer(process);
    if (answer->state == AnswerState::kRefused) return ReportRefused(*answer);
    fleet->answers.emplace(process, std::move(*answer));
  }
  // A process that keeps its QoS must still receive the others. Those that do not answer are left
  // out. One that the first search missed is a target like all others.
  for (const VehicleId process : Everyone(client, kOfTheRest, fleet)) {
    if (fleet->answers.contains(process)) continue;
    auto answer = client->AskQos(process, kReportPatience);
    if (!answer) continue;
    if (answer->state == AnswerState::kRefused) {
      fleet->not_administrable.push_back(process);
      continue;
    }
    fleet->answers.emplace(process, std::move(*answer));
    if (options.all) fleet->targets.push_back(process);
  }
  return 0;
}

}  // namespace giveway::fleetctl
