// The defects of services/vehicle/estimation/injected_mutants.h by name, for programs that inject
// those an environment variable names.
#pragma once

#include <algorithm>
#include <ranges>
#include <string_view>

#include "services/vehicle/estimation/injected_mutants.h"

namespace giveway {

struct NamedMutant {
  std::string_view name;
  Mutant mutant;
};

inline constexpr NamedMutant kNamedMutants[] = {
    {"priority_reversed", Mutant::kPriorityReversed},
    {"tie_yields_both", Mutant::kTieYieldsBoth},
    {"tie_frees_both", Mutant::kTieFreesBoth},
    {"measured_speed_in_order", Mutant::kMeasuredSpeedInOrder},
    {"lending_dropped", Mutant::kLendingDropped},
    {"waiting_never_counts", Mutant::kWaitingNeverCounts},
    {"own_beacon_heard", Mutant::kOwnBeaconHeard},
    {"stale_beacon_trusted", Mutant::kStaleBeaconTrusted},
    {"lost_peer_forgotten", Mutant::kLostPeerForgotten},
    {"silence_is_consent", Mutant::kSilenceIsConsent},
    {"released_without_looking", Mutant::kReleasedWithoutLooking},
    {"lost_peer_held_for_ever", Mutant::kLostPeerHeldForEver},
    {"second_drives_on", Mutant::kSecondDrivesOn},
    {"through_first_guessed", Mutant::kThroughFirstGuessed},
    {"grant_not_needed", Mutant::kGrantNotNeeded},
    {"leader_is_conflict", Mutant::kLeaderIsConflict},
    {"arrived_claims_way", Mutant::kArrivedClaimsWay},
    {"claim_ignored", Mutant::kClaimIgnored},
    {"claim_without_way", Mutant::kClaimWithoutWay},
    {"brakes_too_late", Mutant::kBrakesTooLate},
    {"obstacle_ignored", Mutant::kObstacleIgnored},
    {"mover_ignored", Mutant::kMoverIgnored},
    {"signal_ignored", Mutant::kSignalIgnored},
    {"steers_round_nobody", Mutant::kSteersRoundNobody},
    {"queue_overtaken", Mutant::kQueueOvertaken},
    {"patience_dropped", Mutant::kPatienceDropped},
    {"place_forgotten", Mutant::kPlaceForgotten},
    {"route_forgotten", Mutant::kRouteForgotten},
};

// False where no defect has the name.
inline bool ActivateNamedMutant(std::string_view name) {
  const auto* const found = std::ranges::find(kNamedMutants, name, &NamedMutant::name);
  if (found == std::ranges::end(kNamedMutants)) return false;
  ActivateMutant(found->mutant);
  return true;
}

}  // namespace giveway
