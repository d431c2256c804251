// Defects of the rules that tests plant, one at a time, to see that each is caught
// (tests/virtual/defects.sh). A vehicle is compiled without them: nothing is planted there, the
// compiler knows it, and leaves no instruction of any.
#pragma once

#include <cstdint>

namespace giveway {

enum class Defect : std::uint8_t {
  kNone,
  // The order.
  kPriorityReversed,
  kTieYieldsBoth,
  kTieFreesBoth,
  kMeasuredSpeedInOrder,
  kOrderNotFrozen,
  kAgeingDropped,
  kLendingDropped,
  // Whom to believe, and for how long.
  kOwnBeaconHeard,
  kStaleBeaconTrusted,
  kReplayedBeaconTaken,
  kLostPeerForgotten,
  kLostPeerHeldForEver,
  // Encounters.
  kLatchDropped,
  kEncounterNeverEnds,
  kGrantNotNeeded,
  kGrantOfAnybody,
  kWordGivenTooLate,
  kConflictNotCleared,
  kEnteredForgotten,
  kBoxNotLookedAt,
  kCriticalWithoutBraking,
  kLeaderIsConflict,
  kArrivedClaimsWay,
  // What never rests on agreement.
  kClaimIgnored,
  kClaimWithoutWay,
  kReactionLeftOut,
  kObstacleIgnored,
  kMoverIgnored,
  kSignalIgnored,
  // Ways.
  kDetourDropped,
  kSteersRoundNobody,
  kQueueOvertaken,
  kPatienceDropped,
};

#ifdef GIVEWAY_PLANTED_DEFECTS
namespace internal {
inline Defect planted = Defect::kNone;
}
// Before the first vehicle is made.
inline void Plant(Defect defect) { internal::planted = defect; }
inline bool Has(Defect defect) { return internal::planted == defect; }
#else
constexpr bool Has(Defect /*defect*/) { return false; }
#endif

}  // namespace giveway
