// What vehicles' ultrasonics deliver, tick by tick, in the scenario's tier. The tiers build on each
// other: ideal (exact, every tick), typical (blind zone, noise, incidence cut-off, drop-outs; edges
// and corners answer too, sonar_corners.h), p3dx (one transducer of each array at a time, slot by
// slot) and crosstalk (others' pulses are heard).
// Every random number depends only on seed, vehicle, time since the start and transducer, so
// neither the order of the vehicles nor the number of threads changes the result.
//
// The world calls Sense once a tick, after the bodies have moved:
//
//   sonar_.Sense(tick, [this](double before_s) { return InstantBefore(before_s); }, parallel);
//
// where InstantBefore puts every shape where it was `before_s` ahead of this tick's end, indexes
// the scene and lists the vehicles that sense with their poses of that moment. It is asked once
// with 0 in tiers ideal and typical, and once for each slot that starts in this tick in p3dx and
// crosstalk, so perhaps never or several times, in order of time, and not always for the tick's
// end. It must name the same vehicles each time within a tick. Afterwards SonarState::readings is
// the scan.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>

#include "services/types/parallel.h"
#include "services/types/range_scan.h"
#include "services/types/scenario.h"
#include "sim_world/sensors/scene.h"
#include "sim_world/sensors/sonar_crosstalk.h"
#include "sim_world/sensors/sonar_ring.h"
#include "sim_world/sensors/sonar_schedule.h"

namespace giveway::sim {

// One vehicle's ultrasonics between ticks. Plain data: a copy is a checkpoint. A vehicle that joins
// starts with an empty one.
struct SonarState {
  Readings readings{};  // as they can be read now; what has not fired yet is no data

  // The current slot: what is being heard, and by which transducer.
  struct Listening {
    RangeReading reading;  // kNoData: this array is not listening
    std::uint32_t transducer = 0;
  };
  std::array<Listening, kArrayCount> listening{};
};

// A vehicle that senses, at one instant.
struct SonarSubject {
  VehicleId vehicle = kNoVehicle;
  Owner owner = kNoOwner;  // of its own shapes in the scene
  Pose world_from_body;
  const SonarRing* ring = nullptr;
  SonarState* state = nullptr;  // one's own: subjects are sensed in parallel
};

struct SonarInstant {
  const Scene* scene = nullptr;
  std::span<const SonarSubject> subjects;
};

// A tick as the ultrasonics count it. Whatever is drawn depends on the ticks since the start
// signal, never on how long the world waited for that.
struct SonarTick {
  Tick now = kNoTick;    // readings say when they were fired by it
  Tick draws = kNoTick;  // by which the draws of a tick are numbered, where all fire every tick
  Tick slots = kNoTick;  // by which slots are numbered
};

class Sonar {
 public:
  Sonar(const SonarModel& model, std::uint32_t seed, Nanoseconds tick_period);

  using InstantBefore = std::function<SonarInstant(double before_s)>;
  void Sense(const SonarTick& tick, const InstantBefore& instant_before,
             const ParallelFor& parallel = OnThisThread);
  // The same in a run that started with its first tick.
  void Sense(Tick tick, const InstantBefore& instant_before,
             const ParallelFor& parallel = OnThisThread) {
    Sense(SonarTick{tick, tick, tick}, instant_before, parallel);
  }

 private:
  void SenseAtTick(const SonarTick& tick, const InstantBefore& instant_before,
                   const ParallelFor& parallel);
  void SenseAtSlot(std::uint64_t slot, const SonarTick& tick, const InstantBefore& instant_before,
                   const ParallelFor& parallel);
  void ReadAll(const Scene& scene, const SonarTick& tick, const SonarSubject& subject) const;
  void Fire(std::uint64_t slot, const SonarTick& tick, const SonarInstant& instant,
            std::size_t i) const;

  SonarModel model_;
  Incidence incidence_;
  double edge_reach_m_;  // 0: corners are not heard
  std::uint32_t seed_;
  FiringSchedule schedule_;
  Crosstalk crosstalk_;  // of the slot being sensed
};

}  // namespace giveway::sim
