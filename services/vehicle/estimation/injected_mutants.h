// Defects of the rules that tests inject to check that each is detected (tests/virtual/defects.sh).
// A vehicle is compiled without them: there MutantActive() is constantly false, and the
// compiler removes every check.
#pragma once

#include <cstdint>

namespace giveway {

enum class Mutant : std::uint8_t {
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

#ifdef GIVEWAY_INJECTED_MUTANTS
namespace internal {
inline std::uint64_t active_mutants = 0;  // one bit per mutant
}
// Before the first vehicle is made.
inline void ActivateMutant(Mutant mutant) {
  internal::active_mutants |= 1ULL << static_cast<unsigned>(mutant);
}
inline bool MutantActive(Mutant mutant) {
  return (internal::active_mutants >> static_cast<unsigned>(mutant) & 1U) != 0;
}
#else
constexpr bool MutantActive(Mutant /*mutant*/) { return false; }
#endif

}  // namespace giveway
