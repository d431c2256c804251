// How a service is, as its loop last said it, and what follows: is it live, is it ready, and if
// not, why. Pure: values in, sentences out. health_server.h serves them, health_metrics.h turns
// them into metrics.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "services/types/figures/drive_figures.h"
#include "services/types/figures/packet_counters.h"
#include "services/types/fleet_facts.h"
#include "services/types/time.h"

namespace giveway {

// A loop that is silent for longer hangs: 20 ticks of the shipped period. To the world a second
// without a command is a death, too, and every wait of a vehicle's loop, at joining, leaving and
// restarting included, is shorter. A world in lockstep waits for as long, and may seem to hang
// once.
inline constexpr Nanoseconds kLoopSilenceLimit{1'000'000'000};
// Files and a participant are made before the loop turns, on a machine that may be busy.
inline constexpr Nanoseconds kStartLimit{10'000'000'000};

enum class HealthStage : std::uint8_t { kStarting, kJoining, kUnderWay, kLeaving };

// Whether the loop turns then, so that its silence is a hang. Making a participant, and leaving,
// may take longer than a turn, and have limits of their own.
constexpr bool IsWatched(HealthStage stage) {
  return stage == HealthStage::kJoining || stage == HealthStage::kUnderWay;
}

// A sentence of fixed capacity, so that its holder is a plain value. What does not fit is cut off.
class ShortText {
 public:
  ShortText() = default;
  explicit ShortText(std::string_view text);
  std::string_view View() const { return {bytes_.data(), length_}; }

 private:
  std::array<char, 191> bytes_{};
  std::uint8_t length_ = 0;
};

struct LoopHealth {
  HealthStage stage = HealthStage::kStarting;
  SteadyTime turned{0};  // when it was last heard of
  std::uint64_t turns = 0;
};

struct VehicleHealth {
  LoopHealth loop;
  // While starting: what keeps it from making a participant. While joining: what the world said
  // last. Empty: nothing.
  ShortText waits_for;
  VehicleStatus status;  // as last reported to the fleet
  RunState run_state = RunState::kWaiting;
  std::uint32_t fleet_size = 0;  // vehicles the run waits for, before it starts
  std::uint32_t matched_peers = 0;
  std::uint32_t placements = 0;  // places it was given in a world: the first, and after restarts
  std::uint32_t late_scans = 0;  // overwritten by a newer one before the loop came
  std::uint32_t write_failures = 0;
  std::uint32_t ranges_deadline_missed = 0;
  PacketCounters packets;  // of this process
  SteadyTime scanned{0};   // when the last scan came; 0 before the first
  Nanoseconds ranges_age_limit{0};
  double pose_sigma_m = 0;  // how unsure it is of its position, as a standard deviation
  std::uint32_t fixes_used = 0;
  std::uint32_t fixes_refused = 0;
};

struct WorldHealth {
  LoopHealth loop;
  ShortText waits_for;  // what keeps it from the fleet; empty: nothing
  RunState run_state = RunState::kWaiting;
  double time_s = 0;  // since the start signal
  std::uint32_t late_ticks = 0;
  std::uint32_t vehicles_joined = 0;
  std::uint32_t contacts = 0;
  std::uint32_t reactions = 0;
  std::uint32_t commands_taken = 0;
  std::uint32_t commands_wrong_name = 0;
  std::uint32_t commands_unbound = 0;
  std::uint32_t commands_not_finite = 0;
  std::uint32_t commands_strangers = 0;  // not of the participant that joined as the vehicle
  std::uint32_t joins_refused = 0;       // unread: without a session, or too many of one writer
  std::uint32_t orders_refused = 0;      // of a writer that names too many vehicles
  std::uint32_t write_failures = 0;
  FigureSummary command_latency;  // us: from publishing a command to the tick that applies it
  PacketCounters packets;         // of this process
};

// One sentence a reason; none: it is live, it is ready. A service that is not live is not ready.
using Reasons = std::vector<std::string>;
Reasons NotLive(const LoopHealth& loop, SteadyTime now);
Reasons NotReady(const VehicleHealth& vehicle, SteadyTime now);
Reasons NotReady(const WorldHealth& world, SteadyTime now);

// "live\n" or "not live: REASON\n", a line a reason; as JSON {"live":true,"reasons":[]}.
std::string AsText(std::string_view what, const Reasons& reasons);
std::string AsJson(std::string_view what, const Reasons& reasons);

}  // namespace giveway
