#include "sim_world/sensors/sonar.h"

#include <algorithm>
#include <functional>

#include "sim_world/sensors/sonar_corners.h"
#include "sim_world/sensors/sonar_echo.h"

namespace giveway::sim {
namespace {

// What was heard in the slot that ends now can be read from now on.
void PublishHeard(SonarState* state) {
  for (SonarState::Listening& listening : state->listening) {
    if (listening.reading.kind == Echo::kNoData) continue;
    state->readings[listening.transducer] = listening.reading;
    listening = {};
  }
}

}  // namespace

Sonar::Sonar(const SonarModel& model, std::uint32_t seed, Nanoseconds tick_period)
    : model_(model),
      incidence_(model.tier == SonarTier::kIdeal ? Incidence{}
                                                 : IncidenceUpTo(model.max_incidence_rad)),
      edge_reach_m_(EdgeReach(model.tier)),
      seed_(seed),
      schedule_(model.slot, tick_period, seed) {}

void Sonar::Sense(const SonarTick& tick, const InstantBefore& instant_before,
                  const ParallelFor& parallel) {
  if (model_.tier == SonarTier::kIdeal || model_.tier == SonarTier::kTypical) {
    SenseAtTick(tick, instant_before, parallel);
    return;
  }
  const SlotRange slots = schedule_.StartingIn(tick.slots);
  for (std::uint64_t slot = slots.first; slot < slots.end; ++slot) {
    SenseAtSlot(slot, tick, instant_before, parallel);
  }
}

void Sonar::SenseAtTick(const SonarTick& tick, const InstantBefore& instant_before,
                        const ParallelFor& parallel) {
  const SonarInstant instant = instant_before(0);
  const auto read = [&](std::size_t begin, std::size_t end) {
    for (; begin != end; ++begin) ReadAll(*instant.scene, tick, instant.subjects[begin]);
  };
  parallel(instant.subjects.size(), std::ref(read));  // a reference, so that nothing is allocated
}

void Sonar::ReadAll(const Scene& scene, const SonarTick& tick, const SonarSubject& subject) const {
  const SonarRing& ring = *subject.ring;
  Lanes range_m = ring.Hear(scene, subject.world_from_body, subject.owner, incidence_);
  if (edge_reach_m_ > 0) {
    HearCorners(scene, ring, subject.world_from_body, subject.owner, edge_reach_m_,
                ring.EnabledBits(), &range_m);
  }
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    RangeReading& reading = subject.state->readings[i];
    if (!ring.Enabled(i)) {
      reading = {};
      continue;
    }
    if (model_.tier != SonarTier::kIdeal) {
      range_m.of[i] = Measured(range_m.of[i], model_, ring.MaxRange(),
                               FiringRandom(seed_, subject.vehicle, Number(tick.draws), i));
    }
    reading = ReadingOf(range_m.of[i], tick.now);
  }
}

void Sonar::SenseAtSlot(std::uint64_t slot, const SonarTick& tick,
                        const InstantBefore& instant_before, const ParallelFor& parallel) {
  const SonarInstant instant = instant_before(schedule_.StartsBefore_s(slot, tick.slots));
  if (model_.tier == SonarTier::kCrosstalk) {
    crosstalk_.Clear();
    for (const SonarSubject& subject : instant.subjects) {
      crosstalk_.Add(subject.owner, subject.world_from_body.position_world,
                     PulsesOf(*subject.ring, subject.world_from_body,
                              schedule_.Firing(subject.vehicle, slot)));
    }
    crosstalk_.Index();
  }
  const auto fire = [&](std::size_t begin, std::size_t end) {
    for (; begin != end; ++begin) Fire(slot, tick, instant, begin);
  };
  parallel(instant.subjects.size(), std::ref(fire));
}

void Sonar::Fire(std::uint64_t slot, const SonarTick& tick, const SonarInstant& instant,
                 std::size_t i) const {
  const Scene& scene = *instant.scene;
  const SonarSubject& subject = instant.subjects[i];
  const SonarRing& ring = *subject.ring;
  PublishHeard(subject.state);
  const auto transducers = schedule_.Firing(subject.vehicle, slot);
  SectorSet sectors = 0;
  std::uint32_t fired = 0;
  for (const std::size_t transducer : transducers) {
    sectors |= SectorOf(transducer);
    fired |= 1U << transducer;
  }
  Lanes heard = ring.Hear(scene, subject.world_from_body, subject.owner, incidence_, sectors);
  HearCorners(scene, ring, subject.world_from_body, subject.owner, edge_reach_m_,
              fired & ring.EnabledBits(), &heard);
  for (std::size_t array = 0; array < kArrayCount; ++array) {
    const std::size_t transducer = transducers[array];
    if (!ring.Enabled(transducer)) continue;
    double range_m = heard.of[transducer];
    if (model_.tier == SonarTier::kCrosstalk) {
      range_m = std::min(range_m, crosstalk_.Nearest(scene, i, array));
    }
    range_m = Measured(range_m, model_, ring.MaxRange(),
                       FiringRandom(seed_, subject.vehicle, slot, transducer));
    subject.state->listening[array] = {
        .reading = ReadingOf(range_m, tick.now, schedule_.StartsBefore_s(slot, tick.slots)),
        .transducer = static_cast<std::uint32_t>(transducer)};
  }
}

}  // namespace giveway::sim
