// The world against Box2D 2.4 and Embree 3, over the same bodies at the same poses.
//
// A turn is a few ticks of 1000 vehicles: first the world makes them, then each peer follows the
// poses the world came to. What is timed a vehicle-step:
// - world:  Advance(driving): motors, motion, contacts, walls and all 16 ultrasonics. Its sensing
//           cannot be called alone, so all of it stands against a part of the work.
// - Box2D:  velocities, Step() and 112 rays a vehicle.
// - Embree: new bounds, refit of its tree and 112 rays a vehicle; there is no motion to make.
// Turns alternate in one loop on one core; a figure is the ratio of the medians over the turns.
// That peer and world sensed the same is counted over placements of their own (world_agreement.h).
#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "tests/bench/measure.h"
#include "tests/bench/world_agreement.h"
#include "tests/bench/world_field.h"
#include "tests/bench/world_peers.h"

namespace giveway::bench {
namespace {

constexpr int kTurns = 15;
constexpr std::uint32_t kTicksATurn = 4;
constexpr int kPlacements = 50;
constexpr int kTicksAPlacement = 10;

std::vector<Pose> PosesOf(std::span<const sim::Body> bodies) {
  std::vector<Pose> poses;
  for (const sim::Body& body : bodies) poses.push_back(body.world_from_body);
  return poses;
}

void WorldAgainstPeers(benchmark::State& state) {
  const Scenario field = FieldOf(kThousand, SonarTier::kIdeal);
  BusyWorld world(field);
  world.WarmUp();
  const std::unique_ptr<Peer> peers[] = {MakeBox2dPeer(field), MakeEmbreePeer(field)};
  for (const std::unique_ptr<Peer>& peer : peers) peer->Move(PosesOf(world.Bodies()));
  std::vector<double> world_s;
  std::vector<double> peer_s[2];
  const auto take_turn = [&] {
    std::vector<std::vector<Pose>> poses;
    world_s.push_back(0);
    for (std::uint32_t tick = 0; tick < kTicksATurn; ++tick) {
      world.Command();
      world_s.back() += CpuSecondsOf([&] { world.Advance(); });
      poses.push_back(PosesOf(world.Bodies()));
    }
    for (std::size_t i = 0; i < 2; ++i) {
      peer_s[i].push_back(CpuSecondsOf([&] {
        for (const std::vector<Pose>& tick : poses) {
          peers[i]->Move(tick);
          peers[i]->Sense();
        }
      }));
    }
  };
  for (auto _ : state) {
    for (int turn = 0; turn < kTurns; ++turn) take_turn();
  }
  const double vehicle_steps_us = 1e-6 * kTicksATurn * kThousand.Vehicles();
  state.counters["world_us"] = Median(world_s) / vehicle_steps_us;
  state.counters["box2d_us"] = Median(peer_s[0]) / vehicle_steps_us;
  state.counters["embree_us"] = Median(peer_s[1]) / vehicle_steps_us;
  state.counters["box2d_ratio"] = Median(peer_s[0]) / Median(world_s);
  state.counters["embree_ratio"] = Median(peer_s[1]) / Median(world_s);
}
BENCHMARK(WorldAgainstPeers)->Iterations(1);

// The field with cones wider by this; the vehicles drive as in any other.
Scenario FieldHeardBy(double wider_rad) {
  Scenario field = FieldOf(kThousand, SonarTier::kIdeal);
  for (VehicleOptions& options : field.vehicles) {
    options.profile.sonar_half_angle_rad += wider_rad;
  }
  return field;
}

void Agree(benchmark::State& state, std::unique_ptr<Peer> (*make_peer)(const Scenario&)) {
  const Scenario field = FieldHeardBy(0);
  BusyWorld exact(field);
  BusyWorld wider(FieldHeardBy(kGraze_rad));
  BusyWorld narrower(FieldHeardBy(-kGraze_rad));
  const std::unique_ptr<Peer> peer = make_peer(field);
  Agreement agreement;
  const auto drive_on = [&] {
    for (int tick = 0; tick < kTicksAPlacement; ++tick) {
      for (BusyWorld* world : {&exact, &wider, &narrower}) {
        world->Command();
        world->Advance();
      }
    }
  };
  for (auto _ : state) {
    for (int placement = 0; placement < kPlacements; ++placement) {
      drive_on();
      peer->Move(PosesOf(exact.Bodies()));
      peer->Sense();
      Compare({exact.Bodies(), wider.Bodies(), narrower.Bodies()}, peer->Ranges(), field.walls,
              &agreement);
    }
  }
  const auto share = [&](std::uint64_t part) {
    return 1e6 * static_cast<double>(part) / static_cast<double>(agreement.readings);
  };
  state.counters["readings"] = static_cast<double>(agreement.readings);
  state.counters["on_surface_ppm"] = share(agreement.on_surface);
  state.counters["grazing_ppm"] = share(agreement.grazing);
  state.counters["disagreements"] = static_cast<double>(agreement.disagreements);
  state.counters["worst_excess_m"] = agreement.worst_excess_m;
}
BENCHMARK_CAPTURE(Agree, Box2d, MakeBox2dPeer)->Iterations(1);
BENCHMARK_CAPTURE(Agree, Embree, MakeEmbreePeer)->Iterations(1);

}  // namespace
}  // namespace giveway::bench
