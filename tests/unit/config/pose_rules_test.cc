// How a scenario configures the localization of a vehicle: read, and refused with what to write
// instead. What is appended to the good text is on line 17.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/types/math/math.h"
#include "tests/unit/config/problem_matcher.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

std::vector<Problem> With(const std::string& text) { return ProblemsOf(kGoodScenario + text); }
RobotModel ProfileWith(const std::string& text) {
  return Load(kGoodScenario + text).vehicles[0].profile;
}

TEST(PoseRules, FixesWheelErrorsAndTheLimitReachTheProfile) {
  const RobotModel profile = ProfileWith(
      "profile { sensors { pose_fix { every_s: 0.5 sigma_m: 0.04 dropout: 0.2 sigma_heading_deg: 3 "
      "} "
      "} wheel_error { diameter: 0.01 axle: -0.02 } pose_limit_m: 0.4 }");
  EXPECT_EQ(profile.pose_fix.every_s, 0.5);
  EXPECT_EQ(profile.pose_fix.sigma_m, 0.04);
  EXPECT_EQ(profile.pose_fix.dropout, 0.2);
  EXPECT_DOUBLE_EQ(profile.pose_fix.sigma_heading_rad, Radians(3));
  EXPECT_EQ(profile.wheel_error.diameter, 0.01);
  EXPECT_EQ(profile.wheel_error.axle, -0.02);
  EXPECT_EQ(profile.pose_limit_m, 0.4);
}

TEST(PoseRules, TheLimitIsTheUsualOneWithFixesOrWheelErrorsAndNoneWithout) {
  EXPECT_EQ(ProfileWith("profile { wheel_slip: 0.1 }").pose_limit_m, 0);
  EXPECT_EQ(
      ProfileWith("profile { sensors { pose_fix { every_s: 1 sigma_m: 0.05 } } }").pose_limit_m,
      kUsualPoseLimit_m);
  EXPECT_EQ(ProfileWith("profile { wheel_error { axle: 0.01 } }").pose_limit_m, kUsualPoseLimit_m);
  EXPECT_EQ(ProfileWith("profile { wheel_error { axle: 0.01 } pose_limit_m: 0 }").pose_limit_m, 0);
}

TEST(PoseRules, ASensorWithoutRateOrDeviationIsRefused) {
  EXPECT_THAT(With("profile { sensors { pose_fix { dropout: 0.1 } } }"),
              UnorderedElementsAre(Is(17, "profile.sensors.pose_fix.every_s", "missing"),
                                   Is(17, "profile.sensors.pose_fix.sigma_m", "missing")));
}

TEST(PoseRules, AbsurdFixesAndWheelsAreRefusedAllAtOnce) {
  EXPECT_THAT(With("profile { sensors { pose_fix { every_s: 0 sigma_m: nan dropout: 1 "
                   "sigma_heading_deg: 91 } "
                   "} wheel_error { diameter: 0.3 axle: -0.3 } pose_limit_m: -1 }"),
              UnorderedElementsAre(
                  Is(17, "profile.sensors.pose_fix.every_s", "between 0.005 and 3600 s"),
                  Is(17, "profile.sensors.pose_fix.sigma_m", "not a finite number"),
                  Is(17, "profile.sensors.pose_fix.dropout", "between 0 and 0.99"),
                  Is(17, "profile.sensors.pose_fix.sigma_heading_deg", "between 0 and 90 degrees"),
                  Is(17, "profile.wheel_error.diameter", "between -0.2 and 0.2"),
                  Is(17, "profile.wheel_error.axle", "between -0.2 and 0.2"),
                  Is(17, "profile.pose_limit_m", "between 0 and 10 m")));
}

TEST(PoseRules, FixesTooRoughToFindALostOneByAreRefused) {
  EXPECT_THAT(With("profile { sensors { pose_fix { every_s: 1 sigma_m: 0.2 } } }"),
              ElementsAre(Is(17, "profile.sensors.pose_fix.sigma_m", "more than half")));
  EXPECT_TRUE(With("profile { sensors { pose_fix { every_s: 1 sigma_m: 0.2 } } pose_limit_m: 0.5 }")
                  .empty());
}

// kGoodScenario with a profile for both vehicles, and one of its own for vehicle 2.
constexpr int kOwnLine = 12;
std::string Merged(const std::string& shared, const std::string& own) {
  return Edited("  cruise_m_s: 0.3\n}", "  cruise_m_s: 0.3 " + own + "\n}") + shared;
}

// Regression: the limit was held against the fixes of its own section alone.
TEST(PoseRules, FixesAndLimitOfTwoSectionsAreHeldAgainstEachOther) {
  const std::string rough = "profile { sensors { pose_fix { every_s: 1 sigma_m: 0.15 } } }";
  EXPECT_THAT(ProblemsOf(Merged(rough, "profile { pose_limit_m: 0.05 }")),
              ElementsAre(Is(kOwnLine, "vehicle[1].profile.pose_limit_m", "less than twice")));
  EXPECT_THAT(
      ProblemsOf(Merged("profile { pose_limit_m: 0.05 }", rough)),
      ElementsAre(Is(kOwnLine, "vehicle[1].profile.sensors.pose_fix.sigma_m", "more than half")));
  EXPECT_TRUE(ProblemsOf(Merged(rough, "profile { pose_limit_m: 0.3 }")).empty());
  EXPECT_TRUE(ProblemsOf(Merged(rough, "profile { pose_limit_m: 0 }")).empty());
}

// Regression: "never" became the usual limit again where a vehicle had wheel errors of its own.
TEST(PoseRules, ALimitOfTheScenarioHoldsForVehiclesThatWriteNone) {
  const auto limit_m = [](const std::string& shared, const std::string& own) {
    return Load(Merged(shared, own)).vehicles[1].profile.pose_limit_m;
  };
  const std::string errors = "profile { wheel_error { axle: 0.01 } }";
  EXPECT_EQ(limit_m("profile { pose_limit_m: 0 }", errors), 0);
  EXPECT_EQ(limit_m("profile { pose_limit_m: 0.4 }", errors), 0.4);
  EXPECT_EQ(limit_m("", errors), kUsualPoseLimit_m);
  EXPECT_EQ(limit_m(errors, ""), kUsualPoseLimit_m);
  EXPECT_EQ(limit_m(errors, "profile { pose_limit_m: 0 }"), 0);
}

}  // namespace
}  // namespace giveway
