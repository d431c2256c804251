// The distance metrics at the gates, in a whole fleet: a vehicle that measures by another metric
// stops no later than by the Euclidean one, and the run is as safe.
#include <gtest/gtest.h>

#include "tests/support/crossing.h"

namespace giveway {
namespace {

using Ids = std::set<std::uint32_t>;

Scenario Measured(Scenario scenario, DistanceMetric metric) {
  for (VehicleOptions& vehicle : scenario.vehicles) vehicle.distance_metric = metric;
  return scenario;
}

// The distance vehicle 2 drives until it first gives way; huge if it never does.
double DrivenBeforeGivingWay(const Scenario& scenario) {
  sim::VirtualFleet fleet(scenario);
  const Vec2 from = scenario.vehicles[1].start_world.position_world;
  while (fleet.Advance()) {
    if (fleet.OutputsOf(1).command.decision.rule != Rule::kGiveWay) continue;
    return Norm(fleet.World().Truths()[1].world_from_body.position_world - from);
  }
  return 1e9;
}

struct Case {
  Behaviour behaviour;
  DistanceMetric metric;
};

class Gates : public testing::TestWithParam<Case> {};

TEST_P(Gates, AreNeverPassedLaterThanByTheEuclideanDistance) {
  const auto [behaviour, metric] = GetParam();
  for (const double speed : {0.3, 0.35, 0.4}) {
    const Scenario scenario = test::Crossing(behaviour, 0.4, speed);
    EXPECT_LE(DrivenBeforeGivingWay(Measured(scenario, metric)), DrivenBeforeGivingWay(scenario));
  }
}

TEST_P(Gates, LetTheCrossingEndAsItShould) {
  const auto [behaviour, metric] = GetParam();
  const auto outcome = test::Finish(Measured(test::Crossing(behaviour, 0.4, 0.3), metric));
  EXPECT_EQ(outcome.figures.contacts, 0U);
  EXPECT_EQ(outcome.halted, Ids{2});
  EXPECT_EQ(outcome.arrived, (Ids{1, 2}));
}

INSTANTIATE_TEST_SUITE_P(Of, Gates,
                         testing::Values(Case{Behaviour::kCooperative, DistanceMetric::kManhattan},
                                         Case{Behaviour::kCooperative, DistanceMetric::kChebyshev},
                                         Case{Behaviour::kLectureYield, DistanceMetric::kManhattan},
                                         Case{Behaviour::kLectureYield,
                                              DistanceMetric::kChebyshev}),
                         [](const auto& test) {
                           return std::string(Name(test.param.behaviour)) + "_" +
                                  std::string(Name(test.param.metric));
                         });

// At the crossing the peer lies off axis: it is nearer only by the longer of the two axis
// distances.
TEST(GatesOfTheLecture, ChebyshevMakesItStopSoonerForOneThatIsAskew) {
  const Scenario scenario = test::Crossing(Behaviour::kLectureYield, 0.4, 0.3);
  EXPECT_LT(DrivenBeforeGivingWay(Measured(scenario, DistanceMetric::kChebyshev)) + 0.1,
            DrivenBeforeGivingWay(scenario));
}

// The metric applies to gates only: the printed scripts compare echoes alone.
TEST(GatesOfTheLecture, ThePrintedScriptsKnowOneDistanceOnly) {
  const Scenario scenario = test::Crossing(Behaviour::kLecturePrinted, 0.4, 0.3);
  EXPECT_EQ(DrivenBeforeGivingWay(Measured(scenario, DistanceMetric::kChebyshev)),
            DrivenBeforeGivingWay(scenario));
}

}  // namespace
}  // namespace giveway
