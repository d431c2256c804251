// `fleetctl virtual` over vehicles with the defects planted that GIVEWAY_DEFECT names, commas
// between.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <string_view>

#include "services/fleetctl/args/verbs.h"
#include "services/vehicle/estimation/planted.h"

namespace giveway {
namespace {

struct NamedDefect {
  std::string_view name;
  Defect defect;
};

constexpr NamedDefect kDefects[] = {
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
bool PlantNamed(std::string_view name) {
  const auto* const found = std::ranges::find(kDefects, name, &NamedDefect::name);
  if (found == std::ranges::end(kDefects)) return false;
  Plant(found->defect);
  return true;
}

}  // namespace
}  // namespace giveway

int main(int argc, char** argv) {
  constexpr int kWrongArguments = 2;
  const char* const names = std::getenv("GIVEWAY_DEFECT");
  std::istringstream defects(names == nullptr ? "" : names);
  for (std::string name; std::getline(defects, name, ',');) {
    if (giveway::PlantNamed(name)) continue;
    std::fprintf(stderr, "fleetctl_planted: GIVEWAY_DEFECT: no defect is called '%s'\n",
                 name.c_str());
    return kWrongArguments;
  }
  CLI::App fleetctl("Runs fleets of defective vehicles.", "fleetctl_planted");
  fleetctl.require_subcommand(1);
  int exit_code = kWrongArguments;
  giveway::fleetctl::AddVirtualVerb(&fleetctl, &exit_code);
  CLI11_PARSE(fleetctl, argc, argv);
  return exit_code;
}
