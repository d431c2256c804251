#include "services/config/start_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "services/config/start_sweep.h"
#include "services/types/math/math.h"

namespace giveway {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

// A problem, and the element of the scenario that has it.
struct StartProblem {
  enum class Of : std::uint8_t { kVehicle, kSpawn, kObstacle, kDoor };

  Of of = Of::kVehicle;
  std::size_t index = 0;
  const char* field = "start";
  std::string message;
  std::string remedy;
};

// Everything that stands somewhere at the start, in the order in which the later is blamed.
struct Starts {
  std::vector<StartShape> bodies;  // vehicles, spawn places, obstacles
  std::vector<bool> stands;        // of each body: an obstacle that never moves
  std::vector<bool> turns;         // of each body: see TurnsAtStart
  std::vector<StartLine> walls;
  std::vector<StartLine> doors;
};

// What a body overlaps first, by index.
struct Overlaps {
  std::size_t body = kNone;
  std::size_t wall = kNone;
  std::size_t door = kNone;
};

StartShape ShapeOf(const VehicleOptions& vehicle) {
  const RobotModel& profile = vehicle.profile;
  return {profile.shape, vehicle.start_world, profile.body_radius_m, profile.box_half_m};
}

// Off its path by more than this, a vehicle that steers to a goal turns on the spot first.
constexpr double kTurnsFrom_rad = 0.3;

// True of one with corners that turns on the spot before it drives. Its ultrasonics do not hear
// what the corners come to.
bool TurnsAtStart(const VehicleOptions& vehicle) {
  const bool steers =
      vehicle.behaviour == Behaviour::kCooperative || vehicle.behaviour == Behaviour::kLectureYield;
  const bool has_target = vehicle.route.count > 0 || vehicle.goal.set;
  if (vehicle.profile.shape != BodyShape::kBox || !steers || !has_target) return false;
  const Vec2 target =
      vehicle.route.count > 0 ? vehicle.route.waypoints_world[0] : vehicle.goal.at_world;
  const Vec2 to = target - vehicle.start_world.position_world;
  const double off_rad = WrapAngle(Atan2(to.y, to.x) - vehicle.start_world.heading_rad);
  return Magnitude(off_rad) > kTurnsFrom_rad;
}

Starts Gather(const Scenario& scenario) {
  Starts starts;
  const auto add = [&starts](const StartShape& shape, bool stands, bool turns) {
    starts.bodies.push_back(shape);
    starts.stands.push_back(stands);
    starts.turns.push_back(turns);
  };
  for (const VehicleOptions& vehicle : scenario.vehicles) {
    add(ShapeOf(vehicle), false, TurnsAtStart(vehicle));
  }
  for (const VehicleOptions& place : scenario.spawns) {
    add(ShapeOf(place), false, TurnsAtStart(place));
  }
  for (const Obstacle& o : scenario.obstacles) {
    add({o.shape, o.start_world, o.radius_m, o.box_half_m}, o.waypoints_world.empty(), false);
  }
  for (const Wall& wall : scenario.walls) starts.walls.push_back({wall.from_world, wall.to_world});
  for (const Door& door : scenario.doors) starts.doors.push_back({door.from_world, door.to_world});
  return starts;
}

template <typename T>
std::vector<Bounds> AllBounds(const std::vector<T>& shapes) {
  std::vector<Bounds> bounds;
  for (const T& shape : shapes) bounds.push_back(BoundsOf(shape));
  return bounds;
}

// Of each body the first of each kind it overlaps. What stands for ever may be one thing in several
// bodies, such as an L of two boxes, or be part of a wall. Exact geometry only where that is still
// open: thousands of bodies on one spot are reported as fast as thousands apart.
std::vector<Overlaps> FindOverlaps(const Starts& starts) {
  std::vector<Overlaps> found(starts.bodies.size());
  const auto meet_bodies = [&](std::size_t a, std::size_t b) {
    if (starts.stands[a] && starts.stands[b]) return;
    if (a < found[b].body && Overlap(starts.bodies[a], starts.bodies[b])) found[b].body = a;
  };
  const auto meet_wall = [&](std::size_t body, std::size_t wall) {
    std::size_t& first = found[body].wall;
    if (starts.stands[body]) return;
    if (wall < first && Overlap(starts.bodies[body], starts.walls[wall])) first = wall;
  };
  const auto meet_door = [&](std::size_t body, std::size_t door) {
    std::size_t& first = found[body].door;
    if (door < first && Overlap(starts.bodies[body], starts.doors[door])) first = door;
  };
  const std::vector<Bounds> bodies = AllBounds(starts.bodies);
  Sweep(bodies, AllBounds(starts.walls), {meet_bodies, meet_wall});
  Sweep(bodies, AllBounds(starts.doors), {nullptr, meet_door});
  return found;
}

// All that the corners of a body sweep as it turns on the spot.
StartShape Swept(const StartShape& box) {
  return {BodyShape::kDisc, box.world_from_body, Norm(box.box_half_m), {}};
}

// Of each body that turns at its start the first wall, and the first body that never moves, which
// is clear of it as it stands and not as it turns.
std::vector<Overlaps> FindTurnedInto(const Starts& starts) {
  std::vector<Overlaps> found(starts.bodies.size());
  const auto turns_into = [&](std::size_t body, const auto& other) {
    const StartShape& shape = starts.bodies[body];
    return starts.turns[body] && Overlap(Swept(shape), other) && !Overlap(shape, other);
  };
  const auto meet_bodies = [&](std::size_t a, std::size_t b) {
    std::size_t& first = found[a].body;  // what never moves is an obstacle, and comes later
    if (starts.stands[b] && b < first && turns_into(a, starts.bodies[b])) first = b;
  };
  const auto meet_wall = [&](std::size_t body, std::size_t wall) {
    std::size_t& first = found[body].wall;
    if (wall < first && turns_into(body, starts.walls[wall])) first = wall;
  };
  std::vector<StartShape> swept = starts.bodies;
  for (std::size_t i = 0; i < swept.size(); ++i) {
    if (starts.turns[i]) swept[i] = Swept(swept[i]);
  }
  Sweep(AllBounds(swept), AllBounds(starts.walls), {meet_bodies, meet_wall});
  return found;
}

// Finds the problems of one scenario.
class StartCheck {
 public:
  StartCheck(const Scenario& scenario, std::string cause)
      : scenario_(scenario), cause_(std::move(cause)), starts_(Gather(scenario)) {}

  std::vector<StartProblem> Problems() {
    CheckBodies();
    CheckTurns();
    CheckDoors();
    CheckGoals(scenario_.vehicles, StartProblem::Of::kVehicle);
    CheckGoals(scenario_.spawns, StartProblem::Of::kSpawn);
    return std::move(problems_);
  }

 private:
  // Of a body, by its index among all.
  StartProblem ProblemOf(std::size_t body) const {
    using Of = StartProblem::Of;
    const std::size_t vehicles = scenario_.vehicles.size();
    const std::size_t spawns = scenario_.spawns.size();
    if (body < vehicles) return {.of = Of::kVehicle, .index = body};
    if (body < vehicles + spawns) return {.of = Of::kSpawn, .index = body - vehicles};
    return {.of = Of::kObstacle, .index = body - vehicles - spawns};
  }

  std::string NameOf(std::size_t body) const {
    const StartProblem at = ProblemOf(body);
    if (at.of == StartProblem::Of::kVehicle) {
      return fmt::format("vehicle {}", Number(scenario_.vehicles[body].id));
    }
    const char* const list = at.of == StartProblem::Of::kSpawn ? "spawn" : "obstacle";
    return fmt::format("{}[{}]", list, at.index);
  }

  void Add(StartProblem problem, std::string message, std::string remedy) {
    problem.message = std::move(message);
    problem.remedy = std::move(remedy);
    problems_.push_back(std::move(problem));
  }

  void CheckBodies() {
    const std::vector<Overlaps> found = FindOverlaps(starts_);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const auto [body, wall, door] = found[i];
      if (body != kNone) AddOverlap(i, body);
      if (wall != kNone) AddOverlap(i, starts_.walls[wall], fmt::format("wall[{}]", wall));
      if (door != kNone) {
        AddOverlap(i, starts_.doors[door], fmt::format("the doorway of door[{}]", door));
      }
    }
  }

  void AddOverlap(std::size_t body, std::size_t other) {
    const auto reach_m = [&](std::size_t i) {
      const StartShape& shape = starts_.bodies[i];
      return shape.shape == BodyShape::kBox ? Norm(shape.box_half_m) : shape.radius_m;
    };
    const double distance_m = Norm(starts_.bodies[body].world_from_body.position_world -
                                   starts_.bodies[other].world_from_body.position_world);
    Add(ProblemOf(body),
        fmt::format("{}{} overlaps {}: {:.3f} m between their centres", cause_, NameOf(body),
                    NameOf(other), distance_m),
        fmt::format("move them apart; {:.3f} m is enough whatever their headings",
                    reach_m(body) + reach_m(other) + 0.001));
  }

  void AddOverlap(std::size_t body, const StartLine& line, const std::string& line_name) {
    const double distance_m =
        DistanceToLine(starts_.bodies[body].world_from_body.position_world, line);
    Add(ProblemOf(body),
        fmt::format("{}{} overlaps {}, {:.3f} m from its centre", cause_, NameOf(body), line_name,
                    distance_m),
        "move the start away from there");
  }

  void CheckTurns() {
    const std::vector<Overlaps> found = FindTurnedInto(starts_);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i].body != kNone) AddTurn(i, NameOf(found[i].body));
      if (found[i].wall != kNone) AddTurn(i, fmt::format("wall[{}]", found[i].wall));
    }
  }

  void AddTurn(std::size_t body, const std::string& other) {
    const double reach_m = Norm(starts_.bodies[body].box_half_m);
    Add(ProblemOf(body),
        fmt::format("{}{} turns on the spot there to face where it drives first, and its corners, "
                    "{:.3f} m from its centre, reach {}",
                    cause_, NameOf(body), reach_m, other),
        fmt::format("start it {:.3f} m away from there, or within {:.0f} degrees of where it "
                    "drives first",
                    reach_m + 0.001, Degrees(kTurnsFrom_rad)));
  }

  // A leaf that would cut through a wall or another leaf. Meeting at a jamb is what doors do.
  void CheckDoors() {
    const auto add = [&](std::size_t door, const char* what, std::size_t other) {
      Add({.of = StartProblem::Of::kDoor, .index = door, .field = "to"},
          fmt::format("the leaf crosses {}[{}]", what, other),
          "let it end at the wall, or move it");
    };
    const auto meet_doors = [&](std::size_t a, std::size_t b) {
      if (Cross(starts_.doors[a], starts_.doors[b])) add(b, "door", a);
    };
    const auto meet_wall = [&](std::size_t door, std::size_t wall) {
      if (Cross(starts_.doors[door], starts_.walls[wall])) add(door, "wall", wall);
    };
    Sweep(AllBounds(starts_.doors), AllBounds(starts_.walls), {meet_doors, meet_wall});
  }

  void CheckGoals(const std::vector<VehicleOptions>& vehicles, StartProblem::Of of) {
    for (std::size_t i = 0; i < vehicles.size(); ++i) {
      const VehicleOptions& vehicle = vehicles[i];
      if (!vehicle.goal.set) continue;
      const double distance_m = Norm(vehicle.start_world.position_world - vehicle.goal.at_world);
      if (!(distance_m <= vehicle.goal.radius_m)) continue;  // nor where a number was refused
      Add({.of = of, .index = i},
          fmt::format("{}lies inside the vehicle's own goal, {:.3f} m from its centre", cause_,
                      distance_m),
          "move start and goal apart, or leave the goal out");
    }
  }

  const Scenario& scenario_;
  std::string cause_;
  Starts starts_;
  std::vector<StartProblem> problems_;
};

const Section& SectionOf(const ReadScenario& read, const StartProblem& problem) {
  switch (problem.of) {
    case StartProblem::Of::kVehicle:
      return read.vehicles[problem.index];
    case StartProblem::Of::kSpawn:
      return read.spawns[problem.index];
    case StartProblem::Of::kObstacle:
      return read.obstacles[problem.index];
    case StartProblem::Of::kDoor:
      break;
  }
  return read.doors[problem.index];
}

}  // namespace

void CheckStarts(const ReadScenario& read, const std::string& cause) {
  for (const StartProblem& problem : StartCheck(read.scenario, cause).Problems()) {
    SectionOf(read, problem).AddError(problem.field, problem.message, problem.remedy);
  }
}

void PerturbWithinRules(const std::string& file, Scenario* scenario) {
  PerturbBySeed(scenario);
  ProblemList problems;
  const std::string cause = fmt::format("with seed {} ", scenario->seed);
  for (const StartProblem& problem : StartCheck(*scenario, cause).Problems()) {
    problems.Add({.file = file,
                  .field = problem.field,
                  .message = problem.message,
                  .remedy = problem.remedy});
  }
  if (!problems.Empty()) throw InputError(problems.Sorted());
}

}  // namespace giveway
