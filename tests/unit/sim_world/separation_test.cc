// The closest approach of any two, against every pair by itself.
#include "sim_world/separation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "services/types/math/math.h"
#include "services/types/math/random.h"
#include "tests/unit/sim_world/sim_scenario.h"

namespace giveway::sim {
namespace {

// Vehicles so close together that several pairs come near the minimum, each on an arc of its own;
// now and then one stops within the tick.
class Crowd {
 public:
  explicit Crowd(std::uint64_t seed) : random_(seed) {
    collidables_.bodies = 8;
    for (std::uint32_t i = 0; i < collidables_.bodies; ++i) {
      Body& body = bodies_.emplace_back();
      body.vehicle = VehicleId{i + 1};
      body.present = true;
      body.world_from_body = {{0.7 * i + random_.Uniform(-0.05, 0.05), random_.Uniform(-0.2, 0.2)},
                              random_.Uniform(-kPi, kPi)};
      collidables_.motions.push_back(StandingAt(body.profile, body.world_from_body));
      for (std::uint32_t j = 0; j < i; ++j) pairs_.push_back({.a = i, .b = j});
    }
  }

  void Advance() {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      Motion& motion = collidables_.motions[i];
      motion.start_world = bodies_[i].world_from_body;
      motion.twist = {random_.Uniform(-1, 1), random_.Uniform(-1.7, 1.7)};
      motion.stop_s = random_.Uniform(0, 1) < 0.3 ? random_.Uniform(0, kDt_s) : kDt_s;
      bodies_[i].world_from_body = PoseAt(motion, kDt_s);
    }
    separation_.Observe(bodies_, collidables_, pairs_, kDt_s);
  }

  double ClosestOfAll() const { return separation_.Closest()->gap_m; }
  double ClosestOfAnyPair() const {
    const auto record = separation_.Save().closest_of_pair_m;
    return std::ranges::min_element(record, {}, [](const auto& pair) { return pair.second; })
        ->second;
  }

 private:
  Random random_;
  std::vector<Body> bodies_;
  Collidables collidables_;
  std::vector<NearPair> pairs_;
  Separation separation_{true};
};

TEST(Separation, TheClosestOfAllIsThatOfSomePairTickByTick) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Crowd crowd(seed);
    for (int tick = 0; tick < 10; ++tick) {
      crowd.Advance();
      ASSERT_EQ(crowd.ClosestOfAll(), crowd.ClosestOfAnyPair()) << seed << ' ' << tick;
    }
  }
}

}  // namespace
}  // namespace giveway::sim
