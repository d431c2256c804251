// How timely one life of a vehicle was, over all of it: how old what it decided by was, how even
// its ticks came, how long and how far it drove on before its wheels answered a cause. Measured by
// services/timing; travels in fleet/status. Trivially copyable.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "services/types/ids.h"

namespace giveway {

enum class DriveFigure : std::uint8_t {
  kBeaconAge,         // us: since the tick that the oldest beacon decided by answers, once a step
  kTickJitter,        // us: how far the time between two scans was from what their ticks say
  kTurn,              // us: from waking on a scan to the command sent
  kReaction,          // us: from the scan of the tick that shows a cause to one of obeying wheels
  kReactionDistance,  // um: driven meanwhile
  kReactionShare,     // millionths of the distance that was free as the cause was shown
  kBeaconLatency,     // us: from publishing to reception, the longest of the beacons of a turn
  kScanLatency,       // us: from publishing to reception of a scan
};
inline constexpr std::size_t kDriveFigures = 8;

constexpr std::string_view Name(DriveFigure figure) {
  constexpr std::array<std::string_view, kDriveFigures> kNames{
      "beacon_age",   "tick_jitter",    "turn",           "reaction",
      "reaction_way", "reaction_share", "beacon_latency", "scan_latency"};
  return kNames[static_cast<std::size_t>(figure)];
}

// One figure over a life. A reader that gets one report in kNewest values has met every value.
struct FigureSummary {
  static constexpr std::size_t kNewest = 16;

  std::uint32_t count = 0;
  double sum = 0;
  std::uint32_t p50 = 0;  // 0 where nothing was counted
  std::uint32_t p99 = 0;
  std::uint32_t max = 0;
  std::array<std::uint32_t, kNewest> newest{};  // value n, from 0, stands at n % kNewest

  friend bool operator==(const FigureSummary&, const FigureSummary&) = default;
};

// One reaction against its free distance.
struct ReactionMargin {
  Tick tick = kNoTick;    // of the decision
  double reaction_m = 0;  // driven from cause to obeying wheels
  double free_m = 0;      // that there was at the cause; not negative

  // 0 to 1. Where nothing was free nothing is left: a share of a millimetre would say no more.
  double ShareLeft() const { return reaction_m < free_m ? 1 - reaction_m / free_m : 0; }
  friend bool operator==(const ReactionMargin&, const ReactionMargin&) = default;
};

// With less of the free distance left a reaction has spent its budget.
inline constexpr double kLeastShareLeft = 0.2;

struct DriveFigures {
  std::array<FigureSummary, kDriveFigures> figures{};
  std::optional<ReactionMargin> narrowest;  // the reaction that left the least share
  std::uint32_t budget_spent = 0;           // reactions that left less than kLeastShareLeft
  // Samples that by the two clocks were received before they were published: counted as 0.
  std::uint32_t received_before_sent = 0;

  const FigureSummary& Of(DriveFigure figure) const {
    return figures[static_cast<std::size_t>(figure)];
  }
  friend bool operator==(const DriveFigures&, const DriveFigures&) = default;
};

}  // namespace giveway
