// The shipped scenarios of right of way in virtual time: with every seed they meet their
// expectation, and no invariant is broken. In `head_on` either vehicle may halt: the one that
// passes may stop for a moment when the other sets off.
#include <gtest/gtest.h>

#include "services/config/scenario_file.h"
#include "sim_world/virtual/virtual_run.h"

namespace giveway {
namespace {

Scenario WithSeed(const std::string& name, std::uint32_t seed) {
  ScenarioOverrides overrides;
  overrides.seed = seed;
  return LoadScenario(name, overrides);
}

class ShippedRightOfWay : public testing::TestWithParam<const char*> {};

TEST_P(ShippedRightOfWay, ComesToWhatItExpectsWithEverySeed) {
  for (std::uint32_t seed = 0; seed <= 20; ++seed) {
    const sim::VirtualOutcome outcome = sim::RunVirtually(WithSeed(GetParam(), seed), {});
    EXPECT_EQ(outcome.unmet, "") << "seed " << seed;
    EXPECT_TRUE(outcome.held) << "seed " << seed;
    EXPECT_EQ(outcome.contacts, 0U) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenarios, ShippedRightOfWay,
                         testing::Values("head_on", "three_way", "four_way", "deaf",
                                         "parked_nose_to_nose", "convoy", "intersection_yield",
                                         "intersection_equal", "wall_only", "peer_dies",
                                         "narrow_door", "narrow_passage"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace giveway
