// A pose fix goes to the wire and back unchanged; what is not finite or has no deviation is
// refused.
#include <gtest/gtest.h>

#include <limits>

#include "services/link/convert/convert.h"

namespace giveway::link {
namespace {

PoseFix FixOfOurs() {
  return {.world_from_body = {{1.5, -2.25}, 0.5},
          .sigma_position_m = 0.05,
          .sigma_heading_rad = 0.1,
          .vehicle = VehicleId{7},
          .epoch = WorldEpoch{3},
          .tick = Tick{11}};
}

bool Passes(const PoseFix& fix) {
  PoseFix back;
  return FromWire(ToWire(fix), back);
}

TEST(ConvertPoseFix, ComesBackAsItWas) {
  const PoseFix sent = FixOfOurs();
  PoseFix back;
  ASSERT_TRUE(FromWire(ToWire(sent), back));
  EXPECT_EQ(back.world_from_body, sent.world_from_body);
  EXPECT_EQ(back.sigma_position_m, sent.sigma_position_m);
  EXPECT_EQ(back.sigma_heading_rad, sent.sigma_heading_rad);
  EXPECT_EQ(back.vehicle, sent.vehicle);
  EXPECT_EQ(back.epoch, sent.epoch);
  EXPECT_EQ(back.tick, sent.tick);
}

TEST(ConvertPoseFix, WhatIsNotFiniteIsRefused) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (double PoseFix::*field : {&PoseFix::sigma_position_m, &PoseFix::sigma_heading_rad}) {
      PoseFix fix = FixOfOurs();
      fix.*field = bad;
      EXPECT_FALSE(Passes(fix));
    }
    PoseFix fix = FixOfOurs();
    fix.world_from_body.position_world.x = bad;
    EXPECT_FALSE(Passes(fix));
    fix = FixOfOurs();
    fix.world_from_body.position_world.y = bad;
    EXPECT_FALSE(Passes(fix));
    fix = FixOfOurs();
    fix.world_from_body.heading_rad = bad;
    EXPECT_FALSE(Passes(fix));
  }
}

TEST(ConvertPoseFix, WithoutADeviationOfThePositionIsRefusedAndWithoutOneOfTheHeadingPasses) {
  PoseFix fix = FixOfOurs();
  fix.sigma_heading_rad = 0;
  EXPECT_TRUE(Passes(fix));
  fix.sigma_heading_rad = -0.1;
  EXPECT_FALSE(Passes(fix));
  fix = FixOfOurs();
  fix.sigma_position_m = 0;
  EXPECT_FALSE(Passes(fix));
}

}  // namespace
}  // namespace giveway::link
