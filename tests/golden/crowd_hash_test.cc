// A crowd, pinned: 200 vehicles as discs and boxes, with slip and encoder noise, walls, a cart, a
// box on rails and doors. The same bits for every order of joining and every division of the work.
// A change of the hash is a change of behaviour; update it only when that was intended.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "services/types/math/math.h"
#include "services/types/math/random.h"
#include "sim_world/world.h"
#include "tests/unit/sim_world/cuts.h"

namespace giveway::sim {
namespace {

constexpr WorldEpoch kEpoch{1};
constexpr int kTicks = 400;
constexpr std::uint32_t kVehicles = 200;
constexpr std::uint64_t kGolden = 0x083dbc3f9d8586a7ULL;

VehicleOptions VehicleOf(std::uint32_t id) {
  Random random(11, id);
  VehicleOptions options;
  options.id = VehicleId{id};
  options.profile = PioneerP3dx();
  options.profile.wheel_slip = id % 4 == 0 ? 0.05 : 0;
  options.profile.encoder_noise = id % 5 == 0 ? 0.02 : 0;
  options.profile.sonar_max_range_m = 0.5;  // ultrasonics are not pinned here and take their time
  if (id % 3 == 0) {
    options.profile.shape = BodyShape::kBox;
    options.profile.box_half_m = {0.25, 0.19};
    options.profile.body_radius_m = Norm(options.profile.box_half_m);
  }
  options.start_world = {{1.2 * (id % 15), 1.2 * (id / 15)}, random.Uniform(-kPi, kPi)};
  return options;
}

Scenario Hall() {
  Scenario scenario;
  scenario.seed = 5;
  scenario.walls = {{{-1, -1}, {18, -1}},
                    {{18, -1}, {18, 17}},
                    {{18, 17}, {-1, 17}},
                    {{-1, 17}, {-1, -1}},
                    {{8.6, 2}, {8.6, 6}}};
  scenario.obstacles = {{.radius_m = 0.2,
                         .start_world = {{-0.5, 6.6}, 0},
                         .waypoints_world = {{17, 6.6}, {17, 9}},
                         .loop = true,
                         .speed_m_s = 0.5},
                        {.shape = BodyShape::kBox,
                         .radius_m = 0.5,
                         .box_half_m = {0.4, 0.3},
                         .start_world = {{0.6, 16.3}, 0.3},
                         .waypoints_world = {{17, 16.3}},
                         .speed_m_s = 0.3}};
  scenario.doors = {{.from_world = {8.6, 6}, .to_world = {8.6, 10}, .closed_s = 2, .open_s = 3}};
  return scenario;
}

WheelSpeeds Whim(std::uint32_t id, int tick) {
  Random random(id, static_cast<std::uint64_t>(tick / 20));
  const double left = random.Uniform(-3, 8);
  return {left, left + random.Uniform(-2, 2)};
}

std::vector<VehicleOptions> InOrder() {
  std::vector<VehicleOptions> vehicles;
  for (std::uint32_t id = 1; id <= kVehicles; ++id) vehicles.push_back(VehicleOf(id));
  return vehicles;
}

std::vector<VehicleOptions> Shuffled(std::uint64_t seed) {
  std::vector<VehicleOptions> vehicles = InOrder();
  Random random(seed);
  for (std::size_t i = vehicles.size(); i > 1; --i) {
    std::swap(vehicles[i - 1], vehicles[random.Next() % i]);
  }
  return vehicles;
}

struct Result {
  std::uint64_t hash;
  std::uint32_t contacts;
};

Result Play(const std::vector<VehicleOptions>& joining, ParallelFor parallel) {
  World world(Hall(), kEpoch, std::move(parallel));
  for (const VehicleOptions& options : joining) world.Join(options);
  StateHash hash;
  for (int tick = 0; tick < kTicks; ++tick) {
    for (std::uint32_t id = 1; id <= kVehicles; ++id) {
      MotorCommand command;
      command.vehicle = VehicleId{id};
      command.epoch = kEpoch;
      command.tick = world.Now();
      command.target = Whim(id, tick);
      world.Take(command);
    }
    world.Advance(true);
    for (const Body& body : world.Bodies()) hash.Add(body.encoders.left_rad_s);
  }
  world.AddTo(&hash);
  hash.Add(world.Approaches().Closest()->vehicle);
  return {hash.Value(), world.Contacts()};
}

TEST(CrowdHash, IsTheGoldenOne) {
  const Result result = Play(InOrder(), OnThisThread);
  EXPECT_EQ(result.hash, kGolden) << std::hex << "0x" << result.hash;
  EXPECT_GT(result.contacts, 200U);
}

TEST(CrowdHash, DoesNotDependOnTheOrderOfJoining) {
  EXPECT_EQ(Play(Shuffled(1), OnThisThread).hash, kGolden);
  EXPECT_EQ(Play(Shuffled(2), OnThisThread).hash, kGolden);
}

TEST(CrowdHash, DoesNotDependOnHowTheWorkIsCut) {
  EXPECT_EQ(Play(InOrder(), InPiecesFromTheBack(3)).hash, kGolden);
  EXPECT_EQ(Play(Shuffled(3), InPiecesFromTheBack(7)).hash, kGolden);
}

}  // namespace
}  // namespace giveway::sim
