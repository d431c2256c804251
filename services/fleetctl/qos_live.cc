#include "services/fleetctl/qos_live.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <thread>

#include "services/app/json_line.h"
#include "services/fleetctl/exit_codes.h"
#include "services/fleetctl/qos_effective.h"
#include "services/link/observer_link.h"
#include "services/types/check.h"

namespace giveway::fleetctl {
namespace {

constexpr auto kPatience = std::chrono::seconds(10);
constexpr auto kPoll = std::chrono::milliseconds(20);

// One value of the vehicle's status, and the row of the file it stands for.
struct Told {
  std::string profile;
  std::string value;
  QosRow expected;
};

std::optional<VehicleStatus> StatusOf(const QosLiveOptions& options, const std::string& file) {
  link::LinkOptions link_options;
  link_options.domain = options.domain;
  link_options.interface = options.set.interface;
  link_options.qos_file = file;
  link_options.fleet_size = options.set.vehicles;
  link::ObserverLink observer(link_options);
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < end) {
    for (const VehicleStatus& status : observer.Take().statuses) {
      if (Number(status.vehicle) == options.vehicle) return status;
    }
    std::this_thread::sleep_for(kPoll);
  }
  return std::nullopt;
}

// The status tells milliseconds; infinite is a time nobody lives to see.
std::string DurationOf(double milliseconds) {
  if (milliseconds >= 2147483647e3) return qos::DurationText(qos::kInfinite);
  return qos::DurationText(std::llround(milliseconds * 1e6));
}

Told Beside(const EffectiveSet& set, const std::string& profile, const std::string& policy,
            double milliseconds) {
  const auto endpoint = std::ranges::find(set.endpoints, profile, &EffectiveEndpoint::profile);
  GIVEWAY_CHECK(endpoint != set.endpoints.end(), profile);
  const auto row = std::ranges::find(endpoint->rows, policy, &QosRow::policy);
  GIVEWAY_CHECK(row != endpoint->rows.end(), policy);
  return {profile, DurationOf(milliseconds), *row};
}

std::string ToText(const Told& told, const std::string& file) {
  const std::string origin = OriginText(told.expected, file);
  return fmt::format("  {:<20} {:<17} {:<10} {}\n", told.profile, told.expected.policy, told.value,
                     told.value == told.expected.value
                         ? origin
                         : fmt::format("not {} as by {}", told.expected.value, origin));
}

std::string ToJson(const Told& told) {
  return fmt::format(R"({{"profile":"{}","policy":"{}","value":"{}","expected":"{}","line":{}}})",
                     told.profile, told.expected.policy, told.value, told.expected.value,
                     told.expected.line);
}

void Print(const QosLiveOptions& options, const std::string& file, const std::vector<Told>& all) {
  std::string text;
  for (const Told& told : all) {
    if (options.set.json && !text.empty()) text += ",";
    text += options.set.json ? ToJson(told) : ToText(told, file);
  }
  if (options.set.json) {
    text = fmt::format(R"({{"vehicle":{},"domain":{},"file":{},"values":[{}]}})", options.vehicle,
                       options.domain, app::JsonString(file), text) +
           "\n";
  }
  std::fputs(text.c_str(), stdout);
}

}  // namespace

int RunQosLive(const QosLiveOptions& options) {
  const EffectiveSet set =
      EffectiveQosOfFile(options.set.qos_file, options.set.interface, options.set.vehicles);
  const auto status = StatusOf(options, set.file);
  if (!status) {
    std::fprintf(stderr,
                 "vehicle %u is not heard in domain %u; give the domain and the interface "
                 "that its fleet was started with\n",
                 options.vehicle, options.domain);
    return kCouldNotRun;
  }
  const std::vector<Told> all = {
      Beside(set, "fleet_beacon_writer", "deadline", status->beacon_deadline_offered_ms),
      Beside(set, "fleet_beacon_reader", "deadline", status->beacon_deadline_requested_ms),
      Beside(set, "fleet_beacon_reader", "liveliness_lease", status->beacon_lease_ms)};
  Print(options, set.file, all);
  if (std::fflush(stdout) != 0) return kCouldNotRun;
  const auto as_expected = [](const Told& told) { return told.value == told.expected.value; };
  return std::ranges::all_of(all, as_expected) ? 0 : 1;
}

}  // namespace giveway::fleetctl
