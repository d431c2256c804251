// What the vehicles of a stopwatch fleet say, and which vehicle hears which by it. Pure: lines of
// their logs in, values out.
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
  kHangs,           // its control loop does, from now on
  kBlackoutsCount,  // from now on
};

struct Word {
  SteadyTime at{0};
  WordKind kind = WordKind::kBeaconHeard;
  VehicleId about = kNobody;  // of those about a peer

  friend constexpr bool operator==(const Word&, const Word&) = default;
};

// Of a line of a vehicle's JSON log; nothing where it says something else.
std::optional<Word> WordOf(std::string_view line);

// What reported a peer's absence, where a message is of that.
std::optional<Mechanism> MechanismOf(WordKind kind);

// Which vehicle hears which, by what they have said so far.
class PeersHeard {
 public:
  void Fold(VehicleId hearer, const Word& word);
  // A new life of the vehicle: it has heard no peer yet. What the others think of it stays.
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
