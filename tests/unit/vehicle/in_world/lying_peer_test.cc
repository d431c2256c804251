// A vehicle whose beacons are false touches no other, and the others notice. Where all beacons are
// true no vehicle is distrusted, however bad the ultrasonics.
#include <gtest/gtest.h>

#include "services/types/math/random.h"
#include "tests/support/crossing.h"
#include "tests/support/small_fleet.h"

namespace giveway {
namespace {

using test::SmallFleet;

constexpr VehicleId kLiar{2};

struct Lie {
  const char* name;
  void (*tell)(Beacon* beacon);
  std::uint32_t TrustCounters::*kind;
};

void SayHalted(Beacon* beacon) {
  beacon->wheels = {};
  beacon->rule = Rule::kGiveWay;
  beacon->gives_way_to = VehicleId{1};
}

void ShiftTo(Vec2 by_world, Beacon* beacon) {
  beacon->world_from_body.position_world = beacon->world_from_body.position_world + by_world;
}

class ALyingPeer : public testing::TestWithParam<Lie> {};

TEST_P(ALyingPeer, TouchesNobodyAndIsFoundOut) {
  std::uint32_t found_out = 0;
  for (int i = 0; i < 20; ++i) {
    SmallFleet fleet(test::Crossing(Behaviour::kCooperative, 0.35, 0.25 + 0.01 * i));
    fleet.Lie([](Beacon* beacon) {
      if (beacon->vehicle == kLiar) GetParam().tell(beacon);
    });
    while (fleet.Advance()) {
    }
    EXPECT_EQ(fleet.World().Figures().contacts, 0U) << i;
    found_out += fleet.Brain(0).State().counters.trust.*GetParam().kind > 0 ? 1 : 0;
  }
  EXPECT_GE(found_out, 5U);
}

INSTANTIATE_TEST_SUITE_P(Says, ALyingPeer,
                         testing::Values(Lie{"ThatItHalts", SayHalted,
                                             &TrustCounters::halted_but_closing},
                                         Lie{"ItIsFartherEast",
                                             [](Beacon* beacon) {
                                               ShiftTo({1, 0}, beacon);
                                             },
                                             &TrustCounters::beacon_without_echo},
                                         Lie{"ItIsFartherWest",
                                             [](Beacon* beacon) {
                                               ShiftTo({-1, 0}, beacon);
                                             },
                                             &TrustCounters::beacon_without_echo},
                                         Lie{"ItIsFartherNorth",
                                             [](Beacon* beacon) {
                                               ShiftTo({0, 1}, beacon);
                                             },
                                             &TrustCounters::beacon_without_echo},
                                         Lie{"ItIsFartherSouth",
                                             [](Beacon* beacon) {
                                               ShiftTo({0, -1}, beacon);
                                             },
                                             &TrustCounters::beacon_without_echo}),
                         [](const auto& test) { return std::string(test.param.name); });

struct Tier {
  const char* name;
  SonarTier tier;
  Nanoseconds refresh;
  double noise;
};

class HonestPeers : public testing::TestWithParam<Tier> {};

// Eight in a small field, two of them boxes, with walls and with wheels that slip.
Scenario Crowd(const Tier& tier, std::uint32_t seed) {
  Random random(seed);
  std::vector<VehicleOptions> vehicles;
  for (std::uint32_t id = 1; id <= 8; ++id) {
    const double angle = 2 * kPi * id / 8;
    const Vec2 from = random.Uniform(3, 4) * Vec2{Cos(angle), Sin(angle)};
    // In this order whatever the compiler: arguments of a call have none.
    const double turned_deg = random.Uniform(-20, 20);
    const double cruise_m_s = random.Uniform(0.2, 0.6);
    VehicleOptions options = test::VehicleAt(id, Behaviour::kCooperative, cruise_m_s, from,
                                             Degrees(angle) + 180 + turned_deg, 7);
    options.sonar_refresh = tier.refresh;
    options.sonar_noise = tier.noise;
    options.profile.wheel_slip = 0.02;
    options.profile.encoder_noise = 0.02;
    if (id % 4 == 0) {
      options.profile.shape = BodyShape::kBox;
      options.profile.box_half_m = {0.2, 0.15};
    }
    vehicles.push_back(options);
  }
  Scenario scenario = test::ScenarioOf(vehicles);
  scenario.walls = {{{-6, 5}, {6, 5}}, {{0.6, 1.2}, {1.6, 1.8}}, {{-5, -1}, {-3, -2}}};
  scenario.sonar.tier = tier.tier;
  scenario.seed = seed;
  scenario.duration_s = 40;
  return scenario;
}

TEST_P(HonestPeers, AreNotDoubted) {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    SmallFleet fleet(Crowd(GetParam(), seed));
    std::uint32_t doubted = 0;
    TrustCounters counted;
    while (fleet.Advance()) {
    }
    for (std::size_t i = 0; i < 8; ++i) {
      for (const Peer& peer : fleet.Brain(i).State().heard.peers.Peers()) {
        doubted += peer.trust.ever_doubted ? 1 : 0;
      }
      counted += fleet.Brain(i).State().counters.trust;
    }
    EXPECT_EQ(doubted, 0U) << seed << ": " << counted.beacon_without_echo << " without echo, "
                           << counted.halted_but_closing << " closing, " << counted.jumps
                           << " jumps, " << counted.impossible_speeds << " speeds";
  }
}

INSTANTIATE_TEST_SUITE_P(
    Sonar, HonestPeers,
    testing::Values(Tier{"Ideal", SonarTier::kIdeal, Nanoseconds{0}, 0},
                    Tier{"Typical", SonarTier::kTypical, Nanoseconds{0}, 0.01},
                    Tier{"P3dx", SonarTier::kP3dx, Nanoseconds{360'000'000}, 0.01},
                    Tier{"Crosstalk", SonarTier::kCrosstalk, Nanoseconds{360'000'000}, 0.01}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace giveway
