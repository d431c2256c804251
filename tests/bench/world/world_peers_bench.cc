// The world against Box2D 2.4 and Embree 3, over the same bodies at the same poses.
//
// A turn is a few ticks of 1000 vehicles: first the world makes them, then each peer follows the
// poses the world came to. What is timed a vehicle-step:
// - world:  Advance(driving): motors, motion, contacts, walls and all 16 ultrasonics.
// - sonar:  the world's sensing alone: every shape put into the scene, its index, 16 ranges.
// - Box2D:  velocities, Step() and 112 rays a vehicle: stands against the world.
// - Embree: new bounds, its tree and 112 rays a vehicle, no motion: stands against the sonar.
// Turns alternate in one loop on one core; a figure is the ratio of the medians over the turns.
// That peer and world sensed the same is counted over placements of their own (world_agreement.h).
#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "sim_world/sensors/scene.h"
#include "sim_world/sensors/sonar_ring.h"
#include "tests/bench/measure.h"
#include "tests/bench/world/world_agreement.h"
#include "tests/bench/world/world_field.h"
#include "tests/bench/world/world_peers.h"

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

// The part of Advance that Embree has its like of.
class SonarAlone {
 public:
  explicit SonarAlone(const Scenario& scenario)
      : radius_m_(scenario.vehicles.front().profile.body_radius_m),
        scene_(scenario.walls),
        ring_(scenario.vehicles.front().profile) {}

  void Sense(std::span<const Pose> poses) {
    scene_.Clear();
    for (sim::Owner i = 0; i < poses.size(); ++i) {
      scene_.AddDisc(poses[i].position_world, radius_m_, i);
    }
    scene_.Index();
    ranges_.resize(poses.size());
    for (sim::Owner i = 0; i < poses.size(); ++i) ranges_[i] = ring_.Hear(scene_, poses[i], i);
  }

 private:
  double radius_m_;
  sim::Scene scene_;
  sim::SonarRing ring_;
  std::vector<sim::Lanes> ranges_;
};

// What each contestant's turns took, seconds.
struct Turns {
  std::vector<double> world, sonar, box2d, embree;
};

class Match {
 public:
  Match() {
    world_.WarmUp();
    for (Peer* peer : {box2d_.get(), embree_.get()}) peer->Move(PosesOf(world_.Bodies()));
  }

  void TakeTurns() {
    turns_.world.push_back(0);
    poses_.clear();
    for (std::uint32_t tick = 0; tick < kTicksATurn; ++tick) {
      world_.Command();
      turns_.world.back() += CpuSecondsOf([&] { world_.Advance(); });
      poses_.push_back(PosesOf(world_.Bodies()));
    }
    turns_.sonar.push_back(CpuSecondsOf([&] {
      for (const std::vector<Pose>& tick : poses_) sonar_.Sense(tick);
    }));
    turns_.embree.push_back(TurnOf(*embree_));
    turns_.box2d.push_back(TurnOf(*box2d_));
  }
  const Turns& Taken() const { return turns_; }

 private:
  double TurnOf(Peer& peer) const {
    return CpuSecondsOf([&] {
      for (const std::vector<Pose>& tick : poses_) {
        peer.Move(tick);
        peer.Sense();
      }
    });
  }

  Scenario field_ = FieldOf(kThousand, SonarTier::kIdeal);
  BusyWorld world_{field_};
  SonarAlone sonar_{field_};
  std::unique_ptr<Peer> box2d_ = MakeBox2dPeer(field_);
  std::unique_ptr<Peer> embree_ = MakeEmbreePeer(field_);
  std::vector<std::vector<Pose>> poses_;  // of the turn's ticks
  Turns turns_;
};

void WorldAgainstPeers(benchmark::State& state) {
  Match match;
  for (auto _ : state) {
    for (int turn = 0; turn < kTurns; ++turn) match.TakeTurns();
  }
  const Turns& turns = match.Taken();
  const double vehicle_steps = kTicksATurn * kThousand.Vehicles();
  state.counters["world_us"] = 1e6 * Median(turns.world) / vehicle_steps;
  state.counters["sonar_us"] = 1e6 * Median(turns.sonar) / vehicle_steps;
  state.counters["box2d_us"] = 1e6 * Median(turns.box2d) / vehicle_steps;
  state.counters["embree_us"] = 1e6 * Median(turns.embree) / vehicle_steps;
  state.counters["world_vs_box2d"] = Median(turns.box2d) / Median(turns.world);
  state.counters["world_vs_embree"] = Median(turns.embree) / Median(turns.world);
  state.counters["sonar_vs_embree"] = Median(turns.embree) / Median(turns.sonar);
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
