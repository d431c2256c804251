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

enum class WordKind : std::uint8_t {
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

struct Word {
  SteadyTime at{0};
  WordKind kind = WordKind::kBeaconHeard;
  VehicleId about = kNobody;  // the peer, if it is about one

  friend constexpr bool operator==(const Word&, const Word&) = default;
};

// From a line of a vehicle's JSON log; nullopt if it is something else.
std::optional<Word> WordOf(std::string_view line);

// The mechanism that reported a peer's absence, if the message is about that.
std::optional<Mechanism> MechanismOf(WordKind kind);

// Which vehicle hears which, by their reports so far.
class PeersHeard {
 public:
  void Fold(VehicleId hearer, const Word& word);
  // A new life of the vehicle: it has heard no peer yet. The state of the others about it stays.
  void Restart(VehicleId hearer);
  // Matched once, alive, and with a fresh beacon.
  bool Hears(VehicleId hearer, VehicleId about) const;
  // The first pair that does not hear, if any.
  std::optional<std::pair<VehicleId, VehicleId>> FirstDeaf(std::span<const VehicleId> fleet) const;

 private:
  struct View {
    int writers = 0;  // matched
    bool fresh = false;
    bool alive = true;
  };
  std::map<VehicleId, std::map<VehicleId, View>> views_;  // by hearer
};

}  // namespace giveway::fleetctl
