// The topics that `fleetctl listen` knows, and the output lines of a sample. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "services/link/observer_link.h"
#include "services/types/ids.h"

namespace giveway::fleetctl {

enum class ListenTopic : std::uint8_t {
  kBeacon,
  kStatus,
  kRoster,
  kSignal,
  kTruth,
  kEvent,
  kFigures,
};

std::optional<ListenTopic> ListenTopicNamed(std::string_view name);
std::string_view Name(ListenTopic topic);
// "fleet/beacon, fleet/status, ...".
std::string ListenTopicNames();
// Whether its samples are about vehicles: only those can be chosen by id.
bool IsAboutVehicles(ListenTopic topic);

struct ListenFilter {
  ListenTopic topic = ListenTopic::kBeacon;
  std::set<VehicleId> vehicles;  // empty: all. An event counts if either of its two is among them
  bool json = false;
};

// One line per sample, without its line feed; each says that the sample was received `heard_s`
// after the start.
std::vector<std::string> SampleLines(const link::Observed& observed, const ListenFilter& filter,
                                     double heard_s);

}  // namespace giveway::fleetctl
