// The generators' promises, on two hundred seeds each.
#include "sim_world/virtual/generators.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <ostream>
#include <string>
#include <vector>

#include "services/types/math/math.h"
#include "sim_world/geometry/geometry.h"
#include "sim_world/virtual/arriving.h"
#include "sim_world/virtual/due_times.h"
#include "sim_world/virtual/virtual_run.h"

namespace giveway::sim {

void PrintTo(const Generator& generator, std::ostream* out) { *out << generator.name; }

namespace {

constexpr double kRounding_m = 1e-9;
constexpr double kBody_m = 0.5;  // across

struct Leg {
  Vec2 from;
  Vec2 to;
};

std::vector<Leg> WayOf(const VehicleOptions& options) {
  std::vector<Leg> way;
  Vec2 at = options.start_world.position_world;
  for (std::uint32_t i = 0; i < options.route.count; ++i) {
    way.push_back({at, options.route.waypoints_world[i]});
    at = options.route.waypoints_world[i];
  }
  way.push_back({at, options.goal.at_world});
  return way;
}

double Distance(const Leg& leg, Vec2 point) {
  return Norm(point - NearestOnSegment(leg.from, leg.to, point));
}

// Between two segments that do not cross an end is nearest.
double Distance(const Leg& leg, const Wall& wall) {
  const Leg other{wall.from_world, wall.to_world};
  const double side_a = Cross(leg.to - leg.from, other.from - leg.from);
  const double side_b = Cross(leg.to - leg.from, other.to - leg.from);
  const double side_c = Cross(other.to - other.from, leg.from - other.from);
  const double side_d = Cross(other.to - other.from, leg.to - other.from);
  if (side_a * side_b < 0 && side_c * side_d < 0) return 0;
  return std::min({Distance(leg, other.from), Distance(leg, other.to), Distance(other, leg.from),
                   Distance(other, leg.to)});
}

class EveryGenerator : public testing::TestWithParam<Generator> {
 protected:
  static bool SharesGoals() { return GetParam().name == "shared_goal"; }

  template <typename Check>
  void OnManySeeds(Check check) const {
    for (std::uint32_t seed = 1; seed <= 200; ++seed) {
      const std::uint32_t vehicles = std::vector{2U, 3U, 6U, 11U, 50U}[seed % 5];
      check(GetParam().make({vehicles, seed}),
            "seed " + std::to_string(seed) + ", vehicles " + std::to_string(vehicles));
      if (HasFatalFailure()) return;
    }
  }
};

class GeneratorWithBays : public EveryGenerator {};

TEST_P(EveryGenerator, MakesAsManyVehiclesAsAskedForByAscendingId) {
  OnManySeeds([](const Scenario& scenario, const std::string& which) {
    for (std::size_t i = 0; i < scenario.vehicles.size(); ++i) {
      ASSERT_EQ(Number(scenario.vehicles[i].id), i + 1) << which;
      ASSERT_TRUE(scenario.vehicles[i].goal.set) << which;
      ASSERT_LE(scenario.vehicles[i].cruise_m_s, scenario.vehicles[i].profile.max_speed_m_s);
    }
  });
  EXPECT_EQ(GetParam().make({37, 1}).vehicles.size(), 37U);
}

TEST_P(EveryGenerator, LeavesRoomBetweenStartsAndBetweenGoals) {
  OnManySeeds([&](const Scenario& scenario, const std::string& which) {
    for (const VehicleOptions& a : scenario.vehicles) {
      for (const VehicleOptions& b : scenario.vehicles) {
        if (a.id >= b.id) continue;
        const double starts_m = Norm(a.start_world.position_world - b.start_world.position_world);
        ASSERT_GE(starts_m, kRoom_m - kRounding_m)
            << which << ": " << Number(a.id) << ' ' << Number(b.id);
        if (SharesGoals()) continue;
        ASSERT_GE(Norm(a.goal.at_world - b.goal.at_world), kRoom_m - kRounding_m)
            << which << ": " << Number(a.id) << ' ' << Number(b.id);
      }
    }
  });
}

TEST_P(EveryGenerator, LeadsNoWayThroughAWall) {
  OnManySeeds([](const Scenario& scenario, const std::string& which) {
    for (const VehicleOptions& vehicle : scenario.vehicles) {
      for (const Leg& leg : WayOf(vehicle)) {
        for (const Wall& wall : scenario.walls) {
          ASSERT_GE(Distance(leg, wall), kBody_m / 2 + 0.15) << which << ": " << Number(vehicle.id);
        }
      }
    }
  });
}

// In lanes that end in bays, a vehicle at its goal touches no other vehicle's path.
TEST_P(GeneratorWithBays, PutsGoalsWhereTheyAreInNobodysWay) {
  OnManySeeds([](const Scenario& scenario, const std::string& which) {
    for (const VehicleOptions& a : scenario.vehicles) {
      for (const VehicleOptions& b : scenario.vehicles) {
        if (a.id == b.id) continue;
        for (const Leg& leg : WayOf(b)) {
          ASSERT_GE(Distance(leg, a.goal.at_world), kBody_m + 0.4)
              << which << ": goal of " << Number(a.id) << ", path of " << Number(b.id);
        }
      }
    }
  });
}

TEST_P(EveryGenerator, GivesTheSlowestTimeToSpare) {
  OnManySeeds([](const Scenario& scenario, const std::string& which) {
    for (const VehicleOptions& vehicle : scenario.vehicles) {
      ASSERT_GE(scenario.duration_s, FreeFlowSeconds(vehicle) + 60) << which;
    }
  });
}

// Else `delay` could not break before `arrival` does.
TEST_P(EveryGenerator, IsOverAfterEveryoneWasDue) {
  OnManySeeds([](const Scenario& scenario, const std::string& which) {
    for (const DueTime& due : DueTimes(scenario, ThroughMetres(GetParam(), scenario))) {
      ASSERT_LT(due.at_s, scenario.duration_s) << which << ": " << Number(due.vehicle);
    }
  });
}

TEST_P(EveryGenerator, MakesTheSameOfTheSameSeedAndAnotherOfAnother) {
  const auto starts = [](const Scenario& scenario) {
    std::vector<double> numbers;
    for (const VehicleOptions& vehicle : scenario.vehicles) {
      numbers.push_back(vehicle.start_world.position_world.x);
      numbers.push_back(vehicle.cruise_m_s);
      numbers.push_back(vehicle.goal.at_world.y);
    }
    return numbers;
  };
  EXPECT_EQ(starts(GetParam().make({9, 4})), starts(GetParam().make({9, 4})));
  EXPECT_NE(starts(GetParam().make({9, 4})), starts(GetParam().make({9, 5})));
}

INSTANTIATE_TEST_SUITE_P(Of, EveryGenerator, testing::ValuesIn(Generators()),
                         [](const auto& test) { return std::string(test.param.name); });

// Not an open field, and no parking in the order of a queue.
std::vector<Generator> WithBays() {
  std::vector<Generator> with_bays;
  std::ranges::copy_if(Generators(), std::back_inserter(with_bays), [](const Generator& generator) {
    const std::string name(generator.name);
    const bool open = name == "swarm" || name == "shared_goal" || name == "mixed_yard";
    return !open && name != "crossing" && name != "convoy" && name != "antipodal" &&
           name != "parking";
  });
  return with_bays;
}
INSTANTIATE_TEST_SUITE_P(Of, GeneratorWithBays, testing::ValuesIn(WithBays()),
                         [](const auto& test) { return std::string(test.param.name); });

// In one lane the goals lie in the order of the queue, so a vehicle reaches its goal without
// passing those of the vehicles behind it.
TEST(ConvoyGenerator, ParksInTheOrderOfTheQueue) {
  const Scenario convoy = MakeConvoy({20, 3});
  for (std::size_t i = 0; i + 1 < convoy.vehicles.size(); ++i) {
    EXPECT_GT(convoy.vehicles[i].start_world.position_world.x,
              convoy.vehicles[i + 1].start_world.position_world.x);
    EXPECT_GT(convoy.vehicles[i].goal.at_world.x, convoy.vehicles[i + 1].goal.at_world.x);
  }
}

TEST_P(EveryGenerator, SaysThatEveryoneArrivesOrOneOfThoseWhoShareAGoal) {
  OnManySeeds([&](const Scenario& scenario, const std::string& which) {
    const Arriving arriving = WhoCanArrive(scenario);
    if (!SharesGoals()) {
      ASSERT_EQ(arriving.each.size(), scenario.vehicles.size()) << which;
      return;
    }
    ASSERT_EQ(arriving.one_of.size(), scenario.vehicles.size() / 2) << which;
    ASSERT_TRUE(arriving.each.empty()) << which;
  });
}

// A body of the largest size that is drawn gets through.
TEST(NarrowGenerators, LetTheLargestThroughAndNoTwoAbreast) {
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    for (const char* name : {"door", "one_lane"}) {
      const Generator& generator = *FindGenerator(name);
      const Scenario scenario = generator.make({4, seed});
      ASSERT_EQ(scenario.walls.size(), 8U);
      const double width_m = scenario.walls[0].from_world.y - scenario.walls[6].from_world.y;
      EXPECT_GE(width_m, 2 * generator.most_radius_m + 0.3) << name << " " << seed;
      EXPECT_LE(width_m, scenario.name == "door" ? 1.8 : 1.1) << name << " " << seed;
    }
  }
}

// Both waypoints of the passage lie in the section, every start outside, and one that waits at one
// end hears those at the other.
TEST(NarrowGenerators, SayInTheMapWhereNoTwoPass) {
  constexpr double kTwoBodies_m = 1.5;
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    for (const char* name : {"door", "one_lane"}) {
      const Scenario scenario = FindGenerator(name)->make({8, seed});
      const double width_m = scenario.walls[0].from_world.y - scenario.walls[6].from_world.y;
      ASSERT_EQ(scenario.one_lanes.size(), width_m < kTwoBodies_m ? 1U : 0U) << name << seed;
      for (const VehicleOptions& vehicle : scenario.vehicles) {
        ASSERT_EQ(vehicle.one_lanes.size(), scenario.one_lanes.size());
        if (scenario.one_lanes.empty()) continue;
        const OneLane& lane = vehicle.one_lanes[0];
        const auto from_axis = [&lane](Vec2 at) {
          return Distance({lane.from_world, lane.to_world}, at);
        };
        EXPECT_LT(from_axis(vehicle.route.waypoints_world[0]), lane.width_m / 2);
        EXPECT_LT(from_axis(vehicle.route.waypoints_world[1]), lane.width_m / 2);
        EXPECT_GT(from_axis(vehicle.start_world.position_world), lane.width_m / 2 + 0.7);
        EXPECT_GT(vehicle.emission_radius_m,
                  Norm(lane.to_world - lane.from_world) + lane.width_m + 3);
      }
    }
  }
}

TEST(ParkingGenerator, LetsSomeIntoTheBayOfOneThatLeaves) {
  int taken = 0;
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const Scenario scenario = MakeParking({10, seed});
    for (const VehicleOptions& comes : scenario.vehicles) {
      for (const VehicleOptions& leaves : scenario.vehicles) {
        taken += Norm(comes.goal.at_world - leaves.start_world.position_world) < 0.01 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(taken, 25);
  EXPECT_LT(taken, 75);
}

// Close enough that ultrasonics matter, and no path leads into one.
TEST(MixedYardGenerator, PutsThingsCloseBesideTheWays) {
  int close = 0;
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    const Scenario scenario = MakeMixedYard({8, seed});
    for (const Obstacle& obstacle : scenario.obstacles) {
      if (obstacle.speed_m_s > 0) continue;
      for (const VehicleOptions& vehicle : scenario.vehicles) {
        for (const Leg& leg : WayOf(vehicle)) {
          const double gap_m = Distance(leg, obstacle.start_world.position_world) -
                               obstacle.radius_m - vehicle.profile.body_radius_m;
          ASSERT_GE(gap_m, 0.15 - kRounding_m) << seed;
          close += gap_m < 0.3 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(close, 50);
}

TEST(CorridorGenerator, IsWideEnoughForTwo) {
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    const Scenario corridor = MakeCorridor({4, seed});
    ASSERT_EQ(corridor.walls.size(), 2U);
    ASSERT_GE(corridor.walls[0].from_world.y - corridor.walls[1].from_world.y, 2 * kBody_m + 0.5);
  }
}

// The slowest takes more than a minute through the longest of them: with twelve seconds each, as
// where paths cross, a fleet that passes one by one is not through in time. 6868 was not.
TEST(CorridorGenerator, LastsUntilEveryoneCanHavePassedItAlone) {
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    const Scenario corridor = MakeCorridor({20, seed});
    const double length_m = corridor.walls[0].to_world.x - corridor.walls[0].from_world.x;
    double through_s = 0;
    for (const VehicleOptions& options : corridor.vehicles) {
      through_s += length_m / options.cruise_m_s;
    }
    EXPECT_GT(corridor.duration_s, through_s) << "seed " << seed;
  }
}

TEST(AnyGenerator, IsFoundByItsName) {
  for (const char* name :
       {"crossing", "roundabout", "corridor", "swarm", "merge", "convoy", "warehouse", "door",
        "one_lane", "antipodal", "parking", "shared_goal", "mixed_yard"}) {
    ASSERT_NE(FindGenerator(name), nullptr) << name;
    EXPECT_EQ(FindGenerator(name)->name, name);
  }
  EXPECT_EQ(FindGenerator("nowhere"), nullptr);
}

}  // namespace
}  // namespace giveway::sim
