// The world's arithmetic, pinned: the same script gives the same bits in every build, on every
// machine, and for every order of joining. A change of the hash is a change of behaviour; put the
// new one here only when that was the intention.
#include <gtest/gtest.h>

#include <vector>

#include "services/types/math/math.h"
#include "sim_world/run/run.h"

namespace giveway::sim {
namespace {

constexpr WorldEpoch kEpoch{1};
constexpr int kTicks = 2000;
constexpr std::uint64_t kGolden = 0xf06ff52c18a7151bULL;

// Two vehicles in a corridor of two walls, near enough to meet each other and the walls.
Scenario Corridor() {
  Scenario scenario;
  for (std::uint32_t id = 1; id <= 2; ++id) {
    VehicleOptions options;
    options.id = VehicleId{id};
    options.profile = PioneerP3dx();
    options.start_world = {{id == 1 ? -2.0 : 2.0, 0.1 * id}, id == 1 ? 0.1 : 3.0};
    scenario.vehicles.push_back(options);
  }
  scenario.walls = {{{-4, -1.2}, {4, -1.2}}, {{-4, 1.5}, {4.5, 1.1}}};
  scenario.duration_s = 1000;
  return scenario;
}

// Straights, turns to both sides, spins and reversing, by the tick alone.
WheelSpeeds Script(std::uint32_t id, int tick) {
  constexpr WheelSpeeds kPhases[] = {{4, 4}, {2, 4.5}, {-3, -3}, {5, 1}, {-2, 2}, {6, 6.3}, {0, 0}};
  return kPhases[(static_cast<std::size_t>(tick) / 37 + id * 2) % std::size(kPhases)];
}

struct Result {
  std::uint64_t hash;
  std::uint32_t contacts;
};

Result Play(std::vector<std::uint32_t> joining) {
  Run run(Corridor(), kEpoch);
  for (const std::uint32_t id : joining) run.Join(VehicleId{id});
  run.Start();
  std::uint32_t contacts = 0;
  for (int tick = 0; tick < kTicks; ++tick) {
    std::vector<MotorCommand> commands;
    for (const std::uint32_t id : joining) {
      MotorCommand command;
      command.vehicle = VehicleId{id};
      command.epoch = kEpoch;
      command.tick = run.Now();
      command.target = Script(id, tick);
      commands.push_back(command);
    }
    run.Advance(commands);
    for (const WorldEvent& event : run.Events()) contacts += event.kind == EventKind::kContact;
  }
  return {run.Hash(), contacts};
}

TEST(WorldHash, IsTheGoldenOne) {
  const Result result = Play({1, 2});
  EXPECT_EQ(result.hash, kGolden) << std::hex << "0x" << result.hash;
  EXPECT_GE(result.contacts, 2U);  // contacts are part of what is pinned
}

TEST(WorldHash, DoesNotDependOnTheOrderOfJoining) {
  EXPECT_EQ(Play({2, 1}).hash, Play({1, 2}).hash);
}

}  // namespace
}  // namespace giveway::sim
