// What must be true of every fleet in every tick, judged by the truth and by what the vehicles
// publish. Virtual runs fill in an Observed per vehicle from the brains, real ones from
// world/truth, beacons and status. Counts violations; decides nothing about the run.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "services/types/beacon.h"
#include "services/types/fleet_facts.h"
#include "services/types/scenario.h"
#include "sim_world/virtual/claims.h"
#include "sim_world/virtual/clearance.h"
#include "sim_world/virtual/observed.h"
#include "sim_world/virtual/progress.h"
#include "sim_world/virtual/red_lights.h"
#include "sim_world/virtual/yielding.h"

namespace giveway::sim {

enum class Invariant : std::uint8_t {
  kContact,      // no contact that a moving vehicle caused
  kStaleMotion,  // no motion on stale data: the vehicle is at least braking
  kWaitCycle,    // vehicles that halt to give way to each other never form a cycle
  kWaitBound,    // no vehicle stands in one place longer than a bound, whatever reason it reports
  kAllHalted,    // the vehicles that have not arrived never all halt to give way
  kOrder,        // a vehicle that halts to give way has the lower priority, as both published it
  kArrival,      // every live vehicle arrives within the duration, and at least one is live
  kPose,         // a vehicle was where its beacon says, within the uncertainty it states
  kRedLight,     // no vehicle drives past a red light: red_lights.h
  kProgress,     // no vehicle is stuck: progress.h. The last that RequiredInvariants requires
  // Counted and reported in virtual runs, and enforced only on request: RequiredInvariants.
  kClearance,  // no vehicle drives nearer to anything than its margin: clearance.h
  kClaim,      // every body is where its beacons claim that it can be: claims.h
  kDelay,      // every vehicle arrives when it is due
  kYielding,   // none halts in the path of the one it gives way to: yielding.h
};
inline constexpr std::size_t kInvariantCount = 14;
std::string_view Name(Invariant invariant);
std::optional<Invariant> InvariantNamed(std::string_view name);  // empty if there is none

// By number of the invariant.
using InvariantSet = std::bitset<kInvariantCount>;
// The invariants that a run must keep to pass; all up to kProgress.
InvariantSet RequiredInvariants();

struct Violation {
  Invariant invariant = Invariant::kContact;
  Tick tick = kNoTick;
  VehicleId vehicle = kNoVehicle;  // at fault, or the first concerned
  VehicleId other = kNoVehicle;    // the other one, where there is one
  Rule rule = Rule::kNotRunning;   // by which the vehicle drove or stood, as it reported
};

// By when a vehicle must have arrived, since the start signal.
struct DueTime {
  VehicleId vehicle = kNoVehicle;
  double at_s = 0;
};

struct InvariantLimits {
  double wait_s = 120;             // kWaitBound
  std::uint32_t halted_ticks = 2;  // kAllHalted; lost and late beacons need more
  // kWaitCycle: how long a cycle may last. A decision rests on keys a tick old.
  std::uint32_t cycle_ticks = 1;
  // kOrder: how old a published key may be that a vehicle uses; at most kRememberedKeys - 1.
  std::uint32_t key_age_ticks = 6;
  // kStaleMotion: how much later than it is observed the braking may start.
  std::uint32_t stale_ticks = 0;
  double wedge_s = 60;  // kProgress: how long a crowd may make no progress
  // kArrival: only of these, ascending; absent: of all that have a goal.
  std::optional<std::vector<VehicleId>> arriving;
  // kArrival: of each of these groups, ascending, one live vehicle; all of them may stand forever.
  std::vector<std::vector<VehicleId>> one_of;
  double clearance_m = 0.05;  // kClearance: what vehicles keep from claims (vehicle/situation)
  std::vector<DueTime> due;   // kDelay, ascending; a vehicle not in it may take any time
  InvariantSet required = RequiredInvariants();
  bool counts_others = true;  // also those that are not required
};

class Invariants {
 public:
  static constexpr std::uint32_t kRememberedKeys = 16;
  static constexpr std::size_t kKeptViolations = 64;

  Invariants(const Scenario& scenario, const InvariantLimits& limits);

  // Adds a vehicle that the scenario does not name; one of the same id is forgotten.
  void Admit(const VehicleOptions& options);
  // One of those that is gone permanently: from the next tick on it is not among the vehicles.
  void Forget(VehicleId vehicle);

  // Processes one tick, time_s after the start signal. Vehicles in order of their ids; events are
  // those since the last one. Ticks may be missing: a condition that must last for some ticks then
  // starts again.
  void Observe(Tick tick, double time_s, std::span<const Observed> vehicles,
               std::span<const WorldEvent> events, const Surroundings& around = {});
  // The world was restarted from a state some ticks old: what was published before does not belong
  // to the places in it. The next tick is a later one all the same.
  void NoteRestart();
  // At the end of the run: which vehicles have not arrived? In a closed one, is any live?
  void Finish(Tick tick, std::span<const Observed> vehicles);

  // Each is counted when it starts, not once a tick.
  std::uint32_t Count(Invariant invariant) const {
    return counts_[static_cast<std::size_t>(invariant)];
  }
  // Of those that are required: how often one was broken, and whether none was.
  std::uint64_t Broken() const;
  bool Held() const { return Broken() == 0; }
  // The first ones of those that are required, in order of time.
  std::span<const Violation> First() const { return first_; }
  // The first ones of the others.
  std::span<const Violation> FirstNoted() const { return noted_; }

 private:
  // By the truth.
  struct Place {
    Tick tick = kNoTick;
    Vec2 position_world;
  };
  struct Track {
    VehicleId vehicle = kNoVehicle;
    double deceleration_m_s2 = 0;
    double acceleration_m_s2 = 0;
    bool has_goal = false;
    bool is_box = false;
    double last_speed_m_s = 0;  // of its shell, as far as it decides who is at fault
    Pose last_world;
    bool stale = false;
    std::uint32_t stale_ticks = 0;
    double stale_limit_m_s = 0;  // how fast the faster wheel may still roll
    bool stale_reported = false;
    bool on_route = false;  // for ever
    bool shares_goal =
        false;  // of one of kArrival's groups: it may stand where another has arrived
    Rule rule = Rule::kNotRunning;
    double due_s = 0;   // 0: never, or reported
    Vec2 stands_world;  // has not left it for so many ticks
    std::uint32_t stood_ticks = 0;
    bool order_reported = false;
    std::array<PriorityKey, kRememberedKeys> keys{};  // [tick % kRememberedKeys]
    std::array<Place, kRememberedKeys> places{};      // the same
    bool pose_reported = false;
    std::uint32_t walk = 0;  // scratch of the search for circles
  };

  static Track TrackOf(const VehicleOptions& options);
  static bool Stood(const Track& track, const Observed& now);
  void NoteGap(Tick tick);
  void Report(Invariant invariant, Tick tick, VehicleId vehicle, VehicleId other = kNoVehicle);
  void JudgeContact(const WorldEvent& event, std::span<const Observed> vehicles);
  void JudgeStaleness(Tick tick, const Observed& now, Track* track);
  void JudgeStanding(Tick tick, std::span<const Observed> vehicles);
  void JudgeOrder(Tick tick, const Observed& now, Track* track);
  void JudgePose(Tick tick, const Observed& now, Track* track);
  void JudgeCircles(Tick tick, std::span<const Observed> vehicles);
  void JudgeAllHalted(Tick tick, std::span<const Observed> vehicles);
  void JudgeLightsAndProgress(Tick tick, double time_s, std::span<const Observed> vehicles);
  void JudgeBodies(Tick tick, double time_s, std::span<const Observed> vehicles,
                   const Surroundings& around);
  bool MustArrive(const Track& track) const;
  bool IsAnyOf(const std::vector<VehicleId>& group, std::span<const Observed> vehicles,
               bool arrived) const;
  std::uint32_t IndexOf(VehicleId vehicle) const;
  VehicleId MoreAtFault(const WorldEvent& contact) const;

  InvariantLimits limits_;
  bool open_;
  double dt_s_;
  std::uint32_t wait_ticks_;
  std::uint32_t watchdog_ticks_;
  std::vector<Track> tracks_;
  std::array<std::uint32_t, kInvariantCount> counts_{};
  std::vector<Violation> first_;
  std::vector<Violation> noted_;
  Tick last_tick_ = kNoTick;
  std::uint32_t keys_known_at_ = 0;  // the tick from which on enough keys are remembered
  std::uint32_t circle_ticks_ = 0;
  std::uint32_t halted_ticks_ = 0;
  RedLights red_lights_;
  Progress progress_;
  Clearance clearance_;
  Claims claims_;
  Yielding yielding_;
};

}  // namespace giveway::sim
