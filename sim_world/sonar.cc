#include "sim_world/sonar.h"

namespace giveway::sim {
namespace {

void SenseIdeal(Tick tick, const Scene& scene, const SonarSubject& subject) {
  const Lanes range_m = subject.ring->Hear(scene, subject.world_from_body, subject.owner);
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    RangeReading& reading = subject.state->readings[i];
    reading = {};
    if (!subject.ring->Enabled(i)) continue;
    const bool silent = range_m.of[i] == kSilence_m;
    reading = {.kind = silent ? Echo::kClear : Echo::kEcho,
               .range_m = silent ? 0 : range_m.of[i],
               .tick = tick};
  }
}

}  // namespace

Sonar::Sonar(const SonarModel& model, std::uint32_t, Nanoseconds tick_period)
    : model_(model), tick_period_(tick_period) {}

void Sonar::Sense(Tick tick, const InstantBefore& instant_before, const ParallelFor& parallel) {
  const SonarInstant instant = instant_before(0);
  parallel(instant.subjects.size(), [&](std::size_t begin, std::size_t end) {
    for (; begin != end; ++begin) SenseIdeal(tick, *instant.scene, instant.subjects[begin]);
  });
}

}  // namespace giveway::sim
