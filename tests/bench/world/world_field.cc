#include "tests/bench/world/world_field.h"

#include "services/types/check.h"
#include "services/types/math/math.h"

namespace giveway::bench {
namespace {

constexpr double kCell_m = 2;
constexpr std::uint32_t kCellsAPillar = 4;  // along either axis
constexpr double kPillarHalf_m = 0.5;
// A start this far off the middle of its cell touches neither neighbour nor pillar.
constexpr double kJitter_m = 0.3;
constexpr std::uint32_t kTicksADraw = 20;
constexpr int kWarmUpTicks = 200;
constexpr WorldEpoch kEpoch{1};
constexpr std::uint64_t kSeed = 3;

void AddRectangle(Vec2 low, Vec2 high, std::vector<Wall>* walls) {
  const Vec2 corners[] = {low, {high.x, low.y}, high, {low.x, high.y}};
  for (std::size_t i = 0; i < 4; ++i) walls->push_back({corners[i], corners[(i + 1) % 4]});
}

VehicleOptions VehicleIn(Vec2 cell_middle_world, std::uint32_t id) {
  Random dice(kSeed, id);
  VehicleOptions options;
  options.id = VehicleId{id};
  options.profile = PioneerP3dx();
  for (SensorMount& mount : options.profile.sonar) mount.enabled = true;
  options.start_world.position_world =
      cell_middle_world +
      Vec2{dice.Uniform(-kJitter_m, kJitter_m), dice.Uniform(-kJitter_m, kJitter_m)};
  options.start_world.heading_rad = dice.Uniform(-kPi, kPi);
  return options;
}

WheelSpeeds Draw(const RobotModel& profile, Random* dice) {
  const double forward_m_s = dice->Uniform(-0.5, profile.max_speed_m_s);
  return WheelsFromTwist(profile.drive, {forward_m_s, dice->Uniform(-1, 1)});
}

}  // namespace

Scenario FieldOf(FieldSize size, SonarTier tier) {
  Scenario scenario;
  scenario.name = "field";
  scenario.seed = static_cast<std::uint32_t>(kSeed);
  scenario.sonar.tier = tier;
  const Vec2 half = {kCell_m / 2 * size.columns, kCell_m / 2 * size.rows};
  AddRectangle({-half.x, -half.y}, half, &scenario.walls);
  const auto corner_of = [&](std::uint32_t column, std::uint32_t row) {
    return Vec2{kCell_m * column, kCell_m * row} - half;
  };
  for (std::uint32_t row = 0; row < size.rows; ++row) {
    for (std::uint32_t column = 0; column < size.columns; ++column) {
      const Vec2 corner = corner_of(column, row);
      const auto id = static_cast<std::uint32_t>(scenario.vehicles.size() + 1);
      scenario.vehicles.push_back(VehicleIn(corner + Vec2{kCell_m / 2, kCell_m / 2}, id));
      if (column == 0 || row == 0 || column % kCellsAPillar != 0 || row % kCellsAPillar != 0) {
        continue;
      }
      const Vec2 pillar_half = {kPillarHalf_m, kPillarHalf_m};
      AddRectangle(corner - pillar_half, corner + pillar_half, &scenario.walls);
    }
  }
  return scenario;
}

BusyWorld::BusyWorld(const Scenario& scenario)
    : world_(scenario, kEpoch), targets_(scenario.vehicles.size()) {
  for (const VehicleOptions& options : scenario.vehicles) {
    world_.Join(options.id);
    dice_.emplace_back(scenario.seed, Number(options.id));
  }
}

void BusyWorld::Command() {
  const std::span<const sim::Body> bodies = world_.Bodies();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const bool stopped = bodies[i].wheels == WheelSpeeds{};
    const bool due = (Number(world_.Now()) + i) % kTicksADraw == 0;
    if (stopped || due) targets_[i] = Draw(bodies[i].profile, &dice_[i]);
    MotorCommand command;
    command.vehicle = bodies[i].vehicle;
    command.epoch = kEpoch;
    command.tick = world_.Now();
    command.target = targets_[i];
    GIVEWAY_CHECK(world_.Take(command), Number(command.vehicle));
  }
}

void BusyWorld::WarmUp() {
  for (int tick = 0; tick < kWarmUpTicks; ++tick) {
    Command();
    Advance();
  }
}

}  // namespace giveway::bench
