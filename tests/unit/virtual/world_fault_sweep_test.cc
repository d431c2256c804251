// Each fault of the world alone, on one vehicle of a crossing, over twenty seeds: neither that
// vehicle nor those that meet it touch another.
#include <gtest/gtest.h>

#include <string>

#include "services/faults/kind_table.h"
#include "sim_world/virtual/generators.h"
#include "sim_world/virtual/virtual_run.h"

namespace giveway::sim {
namespace {

constexpr std::uint32_t kSeeds = 20;
constexpr std::uint32_t kCrossingVehicles = 6;

// From shortly after the start until most have crossed, of a vehicle that the seed names.
VirtualPlan PlanOf(faults::Kind kind, std::uint32_t seed) {
  VirtualPlan plan;
  plan.seed = seed;
  plan.schedule = {{.rule = std::string(faults::ToString(kind)),
                    .at_s = 2,
                    .for_s = 20,
                    .kind = kind,
                    .target = {.what = faults::Target::What::kVehicle,
                               .vehicle = VehicleId{1 + seed % kCrossingVehicles}}}};
  return plan;
}

class OneWorldFault : public testing::TestWithParam<faults::Kind> {};

TEST_P(OneWorldFault, TouchesNobody) {
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const VirtualOutcome outcome =
        RunVirtually(MakeCrossing({kCrossingVehicles, seed}), PlanOf(GetParam(), seed));
    EXPECT_EQ(outcome.contacts, 0U) << faults::ToString(GetParam()) << ", seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, OneWorldFault,
                         testing::Values(faults::Kind::kSonarOff, faults::Kind::kSonarStuck,
                                         faults::Kind::kSonarGarbage, faults::Kind::kSonarWrong,
                                         faults::Kind::kSonarSlow, faults::Kind::kSonarDelayed,
                                         faults::Kind::kSonarIntermittent, faults::Kind::kMotorWeak,
                                         faults::Kind::kEncoderWrong),
                         [](const auto& kind) { return std::string(ToString(kind.param)); });

// A vehicle whose wheels keep turning whatever is commanded stops for no peer and drives into those
// that stand: seeds 9 and 11 of these. No two others touch because of it.
TEST(WorldFaultSweep, OneWithStuckWheelsTouchesOthersAndNoTwoOthersTouch) {
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const VirtualPlan plan = PlanOf(faults::Kind::kMotorStuck, seed);
    const VirtualOutcome outcome = RunVirtually(MakeCrossing({kCrossingVehicles, seed}), plan);
    for (const Violation& violation : outcome.first) {
      if (violation.invariant != Invariant::kContact) continue;
      const VehicleId stuck = plan.schedule[0].target.vehicle;
      EXPECT_TRUE(violation.vehicle == stuck || violation.other == stuck) << seed;
    }
  }
}

}  // namespace
}  // namespace giveway::sim
