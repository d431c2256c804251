#include "sim_world/run/expectation.h"

#include <gtest/gtest.h>

#include "tests/unit/sim_world/sim_scenario.h"

namespace giveway::sim {
namespace {

TEST(Expectation, IsMetByWhatItAsksFor) {
  const Expectation expect = {.halted = {kTwo},
                              .arrived = {kOne, kTwo},
                              .parted = true,
                              .min_separation_m = 0.2,
                              .time_to_clear_s = 30};
  const Outcome outcome = {.halted = {kTwo},
                           .arrived = {kOne, kTwo},
                           .parted = true,
                           .min_separation_m = 0.2,
                           .time_to_clear_s = 30};
  EXPECT_EQ(Unmet(expect, outcome), "");
}

TEST(Expectation, NamesWhoHaltedAgainstIt) {
  EXPECT_EQ(Unmet({.halted = {kTwo}}, {.halted = {kOne, kTwo}}), "halted: expected 2, got 1 2");
  EXPECT_EQ(Unmet({.halted = {kTwo}}, {}), "halted: expected 2, got none");
}

TEST(Expectation, NamesEveryMismatchAtOnce) {
  EXPECT_EQ(Unmet({.arrived = {kOne}, .parted = true}, {.contacts = 3}),
            "contacts: expected 0, got 3; arrived: expected 1, got none; "
            "parted: expected true, got false");
}

TEST(Expectation, AFigureThatDoesNotExistMeetsNoBound) {
  EXPECT_EQ(Unmet({.min_separation_m = 0.5}, {}),
            "min_separation_m: expected at least 0.5, got none");
  EXPECT_EQ(Unmet({.time_to_clear_s = 12}, {}), "time_to_clear_s: expected at most 12, got none");
}

TEST(Expectation, ABoundIsKeptOrNamedWithTheFigure) {
  EXPECT_EQ(Unmet({.min_separation_m = 0.5}, {.min_separation_m = 0.499}),
            "min_separation_m: expected at least 0.5, got 0.499");
  EXPECT_EQ(Unmet({.time_to_clear_s = 12}, {.time_to_clear_s = 12.05}),
            "time_to_clear_s: expected at most 12, got 12.05");
}

TEST(Expectation, AHaltCanBeAskedForByItsCause) {
  Expectation expect;
  expect.any_halted = true;
  expect.halted_for = Rule::kUnidentifiedMotion;
  Outcome outcome;
  EXPECT_EQ(Unmet(expect, outcome), "halted_for: expected deaf, got nothing");
  outcome.halted_for = {Rule::kGiveWay, Rule::kPeerLost};
  EXPECT_EQ(Unmet(expect, outcome), "halted_for: expected deaf, got give_way peer_lost");
  outcome.halted_for = {Rule::kGiveWay, Rule::kUnidentifiedMotion};
  EXPECT_EQ(Unmet(expect, outcome), "");
}

TEST(Expectation, WhoHaltsOrArrivesCanBeLeftOpen) {
  Outcome outcome;
  outcome.halted = {kOne};
  outcome.arrived = {kTwo};
  Expectation expect;
  expect.any_halted = true;
  EXPECT_EQ(Unmet(expect, outcome), "arrived: expected none, got 2");
  expect.any_halted = false;
  expect.any_arrived = true;
  EXPECT_EQ(Unmet(expect, outcome), "halted: expected none, got 1");
}

}  // namespace
}  // namespace giveway::sim
