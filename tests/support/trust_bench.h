// A vehicle that stands at the origin and looks east, a peer ahead of it, and what the two senses
// say of that peer.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "services/vehicle/estimation/trust.h"
#include "tests/support/brain_bench.h"

namespace giveway::test {

// Stands ahead of the own vehicle, which stands at the origin and looks east.
inline Beacon Ahead(std::uint32_t tick, double away_m = 3) {
  return BeaconOf(2, tick, {.position_world = {away_m, 0}, .heading_rad = kPi / 2});
}

// Both sensors that point ahead detect a body whose centre is at that distance.
inline RangeScan HearingAhead(double away_m) {
  const SensorMount mount = PioneerP3dx().sonar[3];
  RangeScan scan = ClearScan(0);
  const Vec2 to = Vec2{away_m, 0} - mount.position_body;
  for (const int sensor : {3, 4}) SetEcho(&scan, sensor, Norm(to) - 0.25);
  return scan;
}

class Trust : public testing::Test {
 protected:
  // One tick with a beacon of the tick before.
  void Hear(const RangeScan& scan, Beacon beacon) {
    beacon.tick = Tick{bench_.NextTick() - 1};
    beacon.seq = bench_.NextTick() - 1;
    out_ = bench_.Step(scan, beacon.seq == 0 ? std::vector<Beacon>{} : std::vector{beacon});
  }
  void HearFor(int ticks, const RangeScan& scan, const Beacon& beacon) {
    for (int i = 0; i < ticks; ++i) Hear(scan, beacon);
  }
  void Begin(const VehicleOptions& options) { bench_ = BrainBench(options); }

  const TrustCounters& Counted() const { return bench_.Brain().State().counters.trust; }
  Mode TheMode() const { return out_.command.decision.mode; }
  bool Doubted() const {
    return IsDoubted(bench_.Brain().State().heard.peers.Peers()[0].trust, bench_.Now());
  }

  BrainBench bench_{DefaultOptions()};
  Outputs out_;
};

}  // namespace giveway::test
