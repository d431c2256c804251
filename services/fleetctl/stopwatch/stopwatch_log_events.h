// The reports of the vehicles of a stopwatch fleet, and which vehicle hears which according to
// them. Pure: lines of their logs in, values out.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "services/fleetctl/stopwatch/stopwatch_table.h"
#include "services/types/ids.h"
#include "services/types/time.h"

namespace giveway::fleetctl {

enum class LogEventKind : std::uint8_t {
  kBeaconHeard,
  kBeaconStale,
  kBeaconLeft,
  kDeadlineMissed,
  kLivelinessLost,
  kLivelinessBack,
  kMatched,
  kUnmatched,
  kHangs,           // its control loop hangs from now on
  kBlackoutsCount,  // from now on
};

struct LogEvent {
  SteadyTime at{0};
  LogEventKind kind = LogEventKind::kBeaconHeard;
  VehicleId about = kNoVehicle;  // the peer, if it is about one

  friend constexpr bool operator==(const LogEvent&, const LogEvent&) = default;
};

// From a line of a vehicle's JSON log; nullopt if it is something else.
std::optional<LogEvent> LogEventOf(std::string_view line);

// The mechanism that reported a peer's absence, if the message is about that.
std::optional<Mechanism> MechanismOf(LogEventKind kind);

// Which vehicle hears which, by their reports so far.
class PeersHeard {
 public:
  void Fold(VehicleId hearer, const LogEvent& event);
  // A new life of the vehicle: it has heard no peer yet. The state of the others about it stays.
  void Restart(VehicleId hearer);
  // Matched once, alive, and with a fresh beacon.
  bool Hears(VehicleId hearer, VehicleId about) const;
  // The first pair that does not hear, if any.
  std::optional<std::pair<VehicleId, VehicleId>> FirstUnheard(
      std::span<const VehicleId> fleet) const;

 private:
  struct View {
    int writers = 0;  // matched
    bool fresh = false;
    bool alive = true;
  };
  std::map<VehicleId, std::map<VehicleId, View>> views_;  // by hearer
};

}  // namespace giveway::fleetctl
