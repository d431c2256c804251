// The shipped scenarios of right of way in virtual time: with every seed they come to what they
// expect, and no invariant is broken. Of `deaf` only what a short radio must not cost is asked for:
// safety, and a halt that names its cause.
#include <gtest/gtest.h>

#include "services/app/scenario_file.h"
#include "sim_world/virtual/virtual_run.h"

namespace giveway {
namespace {

Scenario WithSeed(const std::string& name, std::uint32_t seed) {
  app::ScenarioOverrides overrides;
  overrides.seed = seed;
  return app::LoadScenario(name, overrides);
}

class ShippedRightOfWay : public testing::TestWithParam<const char*> {};

TEST_P(ShippedRightOfWay, ComesToWhatItExpectsWithEverySeed) {
  for (std::uint32_t seed = 0; seed <= 20; ++seed) {
    const sim::VirtualOutcome outcome = sim::RunVirtually(WithSeed(GetParam(), seed), {});
    EXPECT_TRUE(outcome.met) << "seed " << seed;
    EXPECT_TRUE(outcome.held) << "seed " << seed;
    EXPECT_EQ(outcome.contacts, 0U) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenarios, ShippedRightOfWay,
                         testing::Values("head_on", "three_way", "four_way", "parked_nose_to_nose",
                                         "convoy", "intersection_yield", "intersection_equal",
                                         "wall_only", "peer_dies"),
                         [](const auto& test) { return std::string(test.param); });

TEST(ShippedRightOfWayOfTheDeaf, NobodyTouchesAndAHaltNamesItsCause) {
  for (std::uint32_t seed = 0; seed <= 20; ++seed) {
    Scenario scenario = WithSeed("deaf", seed);
    ASSERT_EQ(scenario.expect.halted_for, Rule::kDeaf);
    scenario.expect.arrived.clear();
    scenario.expect.any_arrived = true;
    const sim::VirtualOutcome outcome = sim::RunVirtually(scenario, {});
    EXPECT_TRUE(outcome.met) << "seed " << seed;
    EXPECT_EQ(outcome.contacts, 0U) << "seed " << seed;
  }
}

}  // namespace
}  // namespace giveway
