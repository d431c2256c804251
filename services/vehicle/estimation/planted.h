// Defects of the rules that tests inject to check that each is detected (tests/virtual/defects.sh).
// A vehicle is compiled without them: there Has() is constantly false, and the compiler removes
// every check.
#pragma once

#include <cstdint>

namespace giveway {

enum class Defect : std::uint8_t {
  // The order.
  kPriorityReversed,
  kTieYieldsBoth,
  kTieFreesBoth,
  kMeasuredSpeedInOrder,
  kLendingDropped,
  kWaitingNeverCounts,
  // Which data to trust, and for how long.
  kOwnBeaconHeard,
  kStaleBeaconTrusted,
  kLostPeerForgotten,
  kSilenceIsConsent,
  kReleasedWithoutLooking,
  kLostPeerHeldForEver,
  // Encounters.
  kSecondDrivesOn,
  kThroughFirstGuessed,
  kGrantNotNeeded,
  kLeaderIsConflict,
  kArrivedClaimsWay,
  // What never rests on agreement.
  kClaimIgnored,
  kClaimWithoutWay,
  kBrakesTooLate,
  kObstacleIgnored,
  kMoverIgnored,
  kSignalIgnored,
  // Paths.
  kSteersRoundNobody,
  kQueueOvertaken,
  kPatienceDropped,
  // A restarted process of a vehicle that is driving.
  kPlaceForgotten,
  kRouteForgotten,
};

#ifdef GIVEWAY_PLANTED_DEFECTS
namespace internal {
inline std::uint64_t planted = 0;  // a bit a defect
}
// Before the first vehicle is made.
inline void Plant(Defect defect) { internal::planted |= 1ULL << static_cast<unsigned>(defect); }
inline bool Has(Defect defect) {
  return (internal::planted >> static_cast<unsigned>(defect) & 1U) != 0;
}
#else
constexpr bool Has(Defect /*defect*/) { return false; }
#endif

}  // namespace giveway
