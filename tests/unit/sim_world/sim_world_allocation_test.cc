// Counts every allocation of this program: a tick in which nothing happens makes none.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "services/types/math/math.h"
#include "sim_world/run/run.h"
#include "tests/unit/sim_world/sim_scenario.h"

namespace {

std::atomic<std::uint64_t> allocations{0};
std::atomic<std::uint64_t> allocated_bytes{0};

}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  allocated_bytes += size;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
// Otherwise the library's own would be used: not counted, and not compatible with free().
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size == 0 ? 1 : size);
}
// Not inlined: g++ would see free() meet a pointer from operator new, which is what is meant here.
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace giveway::sim {
namespace {

TEST(Allocation, ATickWithoutEventsAllocatesNothing) {
  Scenario scenario;
  for (std::uint32_t id = 1; id <= 8; ++id) {
    scenario.vehicles.push_back(VehicleAt(id, {{id * 2.0, 0}, kPi / 2}));
  }
  scenario.walls = {{{0, -1}, {20, -1}}, {{0, 90}, {20, 90}}};
  sim::Run run(scenario, kEpoch);
  for (const VehicleOptions& options : scenario.vehicles) run.Join(options.id);
  std::vector<MotorCommand> commands(scenario.vehicles.size());
  const auto advance = [&] {
    for (std::uint32_t id = 1; id <= 8; ++id) commands[id - 1] = Drive(id, run.Now(), 3, 3.1);
    run.Advance(commands);
  };
  const std::uint64_t before_joining = allocations;
  EXPECT_GT(before_joining, 0U);  // the count works
  run.Start();
  for (int i = 0; i < 10; ++i) advance();
  const std::uint64_t before = allocations;
  std::size_t events = 0;
  for (int i = 0; i < 500; ++i) {
    advance();
    events += run.Events().size();
  }
  EXPECT_EQ(allocations - before, 0U);
  EXPECT_EQ(events, 0U);
}

// Boxes, slip, a cart, a door and vehicles that run into walls and each other: once every list has
// grown to its size, ticks allocate nothing.
TEST(Allocation, ABusyWorldStopsAllocatingOnceItHasGrown) {
  Scenario scenario;
  for (std::uint32_t id = 1; id <= 40; ++id) {
    scenario.vehicles.push_back(VehicleAt(id, {{0.8 * (id % 8), 0.8 * (id / 8)}, 0.1 * id}));
    RobotModel& profile = scenario.vehicles.back().profile;
    profile.wheel_slip = 0.02;
    if (id % 2 == 0) {
      profile.shape = BodyShape::kBox;
      profile.box_half_m = {0.2, 0.15};
    }
  }
  scenario.walls = {{{-1, -1}, {8, -1}}, {{8, -1}, {8, 6}}, {{8, 6}, {-1, 6}}, {{-1, 6}, {-1, -1}}};
  scenario.obstacles = {{.radius_m = 0.2,
                         .start_world = {{-0.6, 4.6}, 0},
                         .waypoints_world = {{7, 4.6}},
                         .speed_m_s = 0.5}};
  scenario.doors = {{.from_world = {3, 6}, .to_world = {3, 4}, .closed_s = 0.5, .open_s = 0.5}};
  World world(scenario, kEpoch);
  for (const VehicleOptions& options : scenario.vehicles) world.Join(options.id);
  const auto advance = [&](int ticks) {
    for (int tick = 0; tick < ticks; ++tick) {
      const double way = tick / 30 % 2 == 0 ? 4 : -4;
      for (std::uint32_t id = 1; id <= 40; ++id) {
        world.Take(Drive(id, world.Now(), way, id % 3 == 0 ? way + 1 : way));
      }
      world.Advance(true);
    }
  };
  advance(600);
  const std::uint64_t before = allocations;
  const std::uint32_t contacts = world.Contacts();
  advance(400);
  EXPECT_EQ(allocations - before, 0U);
  EXPECT_GT(world.Contacts(), contacts);
}

// Regression: vehicles 200 m apart had all pairs of obstacles searched that far, millions a tick.
TEST(Allocation, ManyObstaclesMakeNoPairsWhereVehiclesAreFarApart) {
  Scenario scenario = ScenarioOf({VehicleAt(1, {{-100, 0}, 0}), VehicleAt(2, {{100, 0}, 0})});
  for (int i = 0; i < 2000; ++i) {
    scenario.obstacles.push_back(
        {.radius_m = 0.2, .start_world = {{i % 50 - 25.0, i / 50 - 20.0}, 0}});
  }
  World world = WorldOf(scenario);
  world.Advance(true);
  const std::uint64_t before = allocated_bytes;
  DriveAll(&world, 3, 3, 5);
  EXPECT_LT(allocated_bytes - before, 1'000'000U);
  ASSERT_TRUE(world.Approaches().Closest());
  EXPECT_NEAR(world.Approaches().Closest()->gap_m, 199.5, 0.1);
}

}  // namespace
}  // namespace giveway::sim
