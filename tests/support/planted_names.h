// The defects of services/vehicle/estimation/planted.h by name, for programs that inject those an
// environment variable names.
#pragma once

#include <algorithm>
#include <ranges>
#include <string_view>

#include "services/vehicle/estimation/planted.h"

namespace giveway {

struct NamedDefect {
  std::string_view name;
  Defect defect;
};

inline constexpr NamedDefect kNamedDefects[] = {
    {"priority_reversed", Defect::kPriorityReversed},
    {"tie_yields_both", Defect::kTieYieldsBoth},
    {"tie_frees_both", Defect::kTieFreesBoth},
    {"measured_speed_in_order", Defect::kMeasuredSpeedInOrder},
    {"lending_dropped", Defect::kLendingDropped},
    {"waiting_never_counts", Defect::kWaitingNeverCounts},
    {"own_beacon_heard", Defect::kOwnBeaconHeard},
    {"stale_beacon_trusted", Defect::kStaleBeaconTrusted},
    {"lost_peer_forgotten", Defect::kLostPeerForgotten},
    {"silence_is_consent", Defect::kSilenceIsConsent},
    {"released_without_looking", Defect::kReleasedWithoutLooking},
    {"lost_peer_held_for_ever", Defect::kLostPeerHeldForEver},
    {"second_drives_on", Defect::kSecondDrivesOn},
    {"through_first_guessed", Defect::kThroughFirstGuessed},
    {"grant_not_needed", Defect::kGrantNotNeeded},
    {"leader_is_conflict", Defect::kLeaderIsConflict},
    {"arrived_claims_way", Defect::kArrivedClaimsWay},
    {"claim_ignored", Defect::kClaimIgnored},
    {"claim_without_way", Defect::kClaimWithoutWay},
    {"brakes_too_late", Defect::kBrakesTooLate},
    {"obstacle_ignored", Defect::kObstacleIgnored},
    {"mover_ignored", Defect::kMoverIgnored},
    {"signal_ignored", Defect::kSignalIgnored},
    {"steers_round_nobody", Defect::kSteersRoundNobody},
    {"queue_overtaken", Defect::kQueueOvertaken},
    {"patience_dropped", Defect::kPatienceDropped},
    {"place_forgotten", Defect::kPlaceForgotten},
    {"route_forgotten", Defect::kRouteForgotten},
};

// False where no defect has the name.
inline bool PlantNamed(std::string_view name) {
  const auto* const found = std::ranges::find(kNamedDefects, name, &NamedDefect::name);
  if (found == std::ranges::end(kNamedDefects)) return false;
  Plant(found->defect);
  return true;
}

}  // namespace giveway
