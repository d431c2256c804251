// What a service hands over to its restarted self arrives complete, or not at all.
#include "services/recording/resumed.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace giveway {
namespace {

Resumed Sample() {
  return {.session = {1, 0xdeadbeef, 0, 0xffffffff},
          .order = 0x0123456789abcdefULL,
          .handover = Handover{.epoch = WorldEpoch{7},
                               .tick = Tick{8},
                               .counted = {-1.5, 1e3 / 3},
                               .world_from_body = {{-0.1, 2e-300}, 3},
                               .covariance = {.xx_m2 = 0.25, .xy_m2 = -0.125, .yy_m2 = 0.5},
                               .task = {3, 400}}};
}

TEST(Resumed, HandsOnWhoItIsWhereItIsAndWhatItWasDoing) {
  EXPECT_EQ(ResumedFrom(ToBytes(Sample())), Sample());
  Resumed without = Sample();
  without.handover.reset();
  EXPECT_EQ(ResumedFrom(ToBytes(without)), without);
}

TEST(Resumed, RefusesBytesThatAreNoneOfItsOwn) {
  const std::string good = ToBytes(Sample());
  std::vector<std::string> bad{"",
                               "giveway-resume-1\n",
                               "x" + good,
                               good + "x",
                               good + good,
                               good.substr(1),
                               std::string(1U << 20U, 'x')};
  for (std::size_t i = 0; i < good.size(); ++i) {
    bad.push_back(good.substr(0, i));
    bad.push_back(good);
    bad.back()[i] = static_cast<char>(bad.back()[i] ^ 0x10);
  }
  for (const std::string& bytes : bad) EXPECT_FALSE(ResumedFrom(bytes)) << bytes;
}

TEST(Resumed, RefusesWhatNoBrainCanGoOnFrom) {
  Resumed resumed = Sample();
  resumed.handover->world_from_body.position_world.x = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(ResumedFrom(ToBytes(resumed)));
  resumed = Sample();
  resumed.handover->covariance.hh_rad2 = -1;
  EXPECT_FALSE(ResumedFrom(ToBytes(resumed)));
}

}  // namespace
}  // namespace giveway
