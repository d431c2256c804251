#include "services/fleetctl/qos/admin_client.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <thread>

#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/qos/awaited_answer.h"
#include "services/fleetctl/qos/qos_apply_report.h"
#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

constexpr auto kPoll = std::chrono::milliseconds(10);

// Polls done() until it is true; false after `patience`, or after that many Ctrl-C.
template <typename Done>
bool WaitUntil(Nanoseconds patience, int interrupts, Done&& done) {
  const SteadyTime end = SteadyNow() + patience;
  while (!done()) {
    if (SteadyNow() >= end || Interrupts::Count() >= interrupts) return false;
    std::this_thread::sleep_for(kPoll);
  }
  return true;
}

}  // namespace

std::vector<VehicleId> AdminClient::Seek(const std::vector<VehicleId>& vehicles,
                                         const Settling::Patience& patience) {
  for (const VehicleId vehicle : vehicles) {
    if (sought_.insert(vehicle).second) link_.Seek(vehicle);
  }
  std::vector<VehicleId> missing = vehicles;
  Settling search(patience, SteadyNow());
  const auto done = [&] {
    std::erase_if(missing, [&](VehicleId vehicle) { return link_.Reaches(vehicle); });
    return missing.empty() || search.Take(vehicles.size() - missing.size(), SteadyNow());
  };
  WaitUntil(patience.limit, 1, done);
  return missing;
}

std::optional<AdminAnswer> AdminClient::Send(AdminRequest order, std::chrono::milliseconds patience,
                                             bool insist) {
  order.number = link::OperatorLink::NextNumber();
  AwaitedAnswer answer(order.vehicle, order.number, has_key_);
  if (!link_.Send(order)) return std::nullopt;
  WaitUntil(patience, insist ? 2 : 1, [&] {
    const SteadyTime now = SteadyNow();
    for (const AdminAnswer& taken : link_.Take()) answer.Take(taken, now);
    ReportRefusals();
    return answer.IsThere(now);
  });
  return answer.Get();
}

std::optional<AdminAnswer> AdminClient::AskQos(VehicleId process,
                                               std::chrono::milliseconds patience, bool insist) {
  return Send({.vehicle = process, .kind = AdminRequestKind::kReportQos, .profiles = {}}, patience,
              insist);
}

void AdminClient::ReportRefusals() {
  for (const Refusal& refusal : link_.TakeRefusals()) {
    const auto line = refusal_log_.Note(refusal, SteadyNow());
    if (line) std::fprintf(stderr, "%s\n", line->c_str());
  }
}

int ReportNotReached(VehicleId vehicle, std::uint32_t domain) {
  const bool interrupted = Interrupts::Count() > 0;
  std::fprintf(
      stderr,
      interrupted
          ? "interrupted before vehicle %u was found in domain %u\n"
          : "no fleet/admin reader of vehicle %u in domain %u; start it with --admin-key or "
            "--admin, and give --domain, --interface and --qos as its fleet has them\n",
      Number(vehicle), domain);
  return interrupted ? 1 : kCouldNotRun;
}

int ReportNoAnswer(VehicleId vehicle) {
  const bool interrupted = Interrupts::Count() > 0;
  std::fprintf(
      stderr,
      interrupted ? "interrupted before %s answered\n" : "%s does not answer; see its log\n",
      NameOf(vehicle).c_str());
  return interrupted ? 1 : kCouldNotRun;
}

int ReportRefused(const AdminAnswer& answer) {
  std::fprintf(stderr, "%s refuses orders of this fleetctl: %s; see --admin-key\n",
               NameOf(answer.vehicle).c_str(), answer.reason.c_str());
  return kCouldNotRun;
}

int ReportNoneReached(std::uint32_t domain) {
  const bool interrupted = Interrupts::Count() > 0;
  std::fprintf(
      stderr,
      interrupted ? "interrupted before anything was found in domain %u\n"
                  : "no fleet/admin reader in domain %u; start vehicles and world with --admin-key "
                    "or --admin, and give --domain, --interface and --qos as their fleet has "
                    "them\n",
      domain);
  return interrupted ? 1 : kCouldNotRun;
}

AdminRequest ApplyRequest(VehicleId vehicle, const QosProfiles& profiles) {
  return {.vehicle = vehicle, .kind = AdminRequestKind::kApply, .profiles = profiles};
}

}  // namespace giveway::fleetctl
