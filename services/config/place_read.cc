#include "services/config/place_read.h"

#include <fmt/format.h>

#include <initializer_list>

#include "services/config/vehicle_read.h"
#include "services/types/math/math.h"

namespace giveway {
namespace {

constexpr double kShortest_m = 0.001;  // of a wall, a leaf, a stop line, a leg between waypoints
constexpr double kFastest_m_s = 10;    // of what is no vehicle
constexpr int kMaxWaypoints = 1024;
constexpr std::int64_t kArraySlots = kSensorCount / 2;
constexpr std::int64_t kMaxRefreshTicks = 100;

struct Ends {
  Vec2 from_world;
  Vec2 to_world;
};

Ends ReadEnds(const Section& section, const char* what) {
  const auto end = [&](const char* field) {
    const auto point = section.RequiredChild(field);
    return point ? ReadPoint(*point) : Vec2{kUnusable, kUnusable};
  };
  const Ends ends{end("from"), end("to")};
  const double length_m = Norm(ends.to_world - ends.from_world);
  if (length_m < kShortest_m) {
    section.AddError("to",
                     fmt::format("the {} has no length: from is {} m away, at least {} is needed",
                                 what, length_m, kShortest_m),
                     fmt::format("move one end, or remove the {}", what));
  }
  return ends;
}

void RefuseWithoutEffect(const Section& section, std::initializer_list<const char*> fields,
                         const char* from_tier) {
  for (const char* field : fields) {
    if (!section.Has(field)) continue;
    section.AddError(field, fmt::format("has no effect below tier {}", from_tier),
                     fmt::format("write tier: {}, or remove it", from_tier));
  }
}

bool KeepsSchedule(SonarTier tier) { return tier >= SonarTier::kP3dx; }

// Ticks that a round of the array takes, a part of one as a whole.
std::int64_t RoundTicks(const SonarModel& sonar, Nanoseconds tick_period) {
  return (kArraySlots * sonar.slot + tick_period - Nanoseconds{1}) / tick_period;
}

void CheckRefresh(const Section& section, const SonarModel& sonar, Nanoseconds tick_period) {
  const std::int64_t ticks = RoundTicks(sonar, tick_period);
  if (!KeepsSchedule(sonar.tier) || ticks <= kMaxRefreshTicks) return;
  section.AddError("slot_ms",
                   fmt::format("a transducer that fires every {:g} ms is refreshed every {} ticks "
                               "of {:g} ms: at most {} are allowed",
                               Milliseconds(kArraySlots * sonar.slot), ticks,
                               Milliseconds(tick_period), kMaxRefreshTicks),
                   "shorten slot_ms or raise tick_period_ms");
}

void ReadShape(const Section& section, Obstacle* obstacle) {
  const auto box = section.Child("box");
  const bool disc = section.Has("disc_radius_m");
  if (disc == box.has_value()) {
    section.AddError(disc ? "disc_radius_m" : "",
                     disc ? "is given together with box" : "the obstacle has no shape",
                     "write one of disc_radius_m: and box { ... }");
  }
  obstacle->radius_m = section.NumberOr(obstacle->radius_m, "disc_radius_m", {0.01, 10, "m"});
  if (!box) return;
  obstacle->shape = BodyShape::kBox;
  obstacle->box_half_m = ReadBox(*box);
  obstacle->radius_m = Norm(obstacle->box_half_m);
}

// Every leg of the route must have a length, the one that closes a loop too.
void CheckLegs(const Section& section, const Obstacle& obstacle) {
  const auto& points = obstacle.waypoints_world;
  Vec2 before = obstacle.start_world.position_world;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (Norm(points[i] - before) < kShortest_m) {
      section.AddError("waypoint", "is where the obstacle is already", "remove it or move it",
                       static_cast<int>(i));
    }
    before = points[i];
  }
  if (obstacle.loop && Norm(before - obstacle.start_world.position_world) < kShortest_m) {
    section.AddError("waypoint", "is the start, to which the loop returns by itself", "remove it",
                     static_cast<int>(points.size()) - 1);
  }
}

void ReadCourse(const Section& section, Obstacle* obstacle) {
  const int count = section.Count("waypoint");
  if (count == 0) {
    for (const char* field : {"speed_m_s", "loop"}) {
      if (!section.Has(field)) continue;
      section.AddError(field, "is given, but there is no waypoint",
                       "write waypoint { x_m: y_m: }, or remove it");
    }
    return;
  }
  obstacle->speed_m_s = section.Number("speed_m_s", {0, kFastest_m_s, "m/s", true});
  obstacle->loop = section.FlagOr(false, "loop");
  if (count > kMaxWaypoints) {
    section.AddError("",
                     fmt::format("has {} waypoints; at most {} are allowed", count, kMaxWaypoints),
                     "leave some out");
    return;
  }
  for (const Section& point : section.Children("waypoint")) {
    obstacle->waypoints_world.push_back(ReadPoint(point));
  }
  CheckLegs(section, *obstacle);
}

// Traffic that runs along its stop line never crosses it.
void CheckCrosses(const Section& section, const SignalPlan& signal) {
  const Vec2 line = signal.line_to_world - signal.line_from_world;
  const Vec2 travel{Cos(signal.travel_rad), Sin(signal.travel_rad)};
  const double across = Cross(line, travel);
  const double least = Sin(Radians(10)) * Norm(line);
  if (across > -least && across < least) {
    section.AddError("heading_deg", "runs along the stop line, not across it",
                     "turn it at least 10 degrees away from the line");
  }
}

}  // namespace

SonarModel ReadSonar(const std::optional<Section>& section, Nanoseconds tick_period) {
  SonarModel sonar;
  if (!section) return sonar;
  if (const auto tier = section->Enum("tier")) {
    sonar.tier = static_cast<SonarTier>(*tier);  // numbered alike; a test holds them together
  }
  sonar.blind_m = section->NumberOr(sonar.blind_m, "blind_m", {0, 1, "m"});
  sonar.noise = section->NumberOr(sonar.noise, "noise", {0, 0.5});
  sonar.drop_out = section->NumberOr(sonar.drop_out, "drop_out", {0, 0.9});
  if (section->Has("max_incidence_deg")) {
    sonar.max_incidence_rad = Radians(section->Number("max_incidence_deg", {1, 90, "degrees"}));
  }
  const double slot_ms = section->NumberOr(Milliseconds(sonar.slot), "slot_ms", {30, 200, "ms"});
  if (slot_ms == slot_ms) sonar.slot = FromSeconds(slot_ms / 1000);
  if (sonar.tier == SonarTier::kIdeal) {
    RefuseWithoutEffect(*section, {"blind_m", "noise", "drop_out", "max_incidence_deg"}, "typical");
  }
  if (!KeepsSchedule(sonar.tier)) RefuseWithoutEffect(*section, {"slot_ms"}, "p3dx");
  CheckRefresh(*section, sonar, tick_period);
  return sonar;
}

Nanoseconds SonarRefresh(const SonarModel& sonar, Nanoseconds tick_period) {
  if (!KeepsSchedule(sonar.tier)) return Nanoseconds{0};
  return RoundTicks(sonar, tick_period) * tick_period + sonar.slot;
}

Wall ReadWall(const Section& section) {
  const Ends ends = ReadEnds(section, "wall");
  return {ends.from_world, ends.to_world};
}

Obstacle ReadObstacle(const Section& section) {
  Obstacle obstacle;
  ReadShape(section, &obstacle);
  obstacle.start_world = ReadStart(section.RequiredChild("start"), 0.0);
  ReadCourse(section, &obstacle);
  return obstacle;
}

OneLane ReadOneLane(const Section& section) {
  const Ends ends = ReadEnds(section, "one-lane section");
  return {ends.from_world, ends.to_world, section.Number("width_m", {0.1, 100, "m"})};
}

Door ReadDoor(const Section& section) {
  constexpr Allowed kPhase{0, 86400, "s"};
  const Ends ends = ReadEnds(section, "door");
  Door door{.from_world = ends.from_world, .to_world = ends.to_world};
  door.closed_s = section.NumberOr(door.closed_s, "closed_s", kPhase);
  door.open_s = section.NumberOr(door.open_s, "open_s", kPhase);
  door.move_s = section.NumberOr(door.move_s, "move_s", {0, 3600, "s", true});
  door.offset_s = section.NumberOr(door.offset_s, "offset_s", kPhase);
  const double speed_m_s = Norm(door.to_world - door.from_world) / door.move_s;
  if (speed_m_s > kFastest_m_s) {
    section.AddError("move_s",
                     fmt::format("makes the leaf slide at {:.4g} m/s; at most {} are allowed",
                                 speed_m_s, kFastest_m_s),
                     "give it more time");
  }
  return door;
}

SignalPlan ReadSignal(const Section& section) {
  SignalPlan signal;
  signal.id = SignalId{section.Uint("id", kId)};
  signal.group = section.UintOr(signal.group, "group", {0, kId.high});
  if (const auto line = section.RequiredChild("line")) {
    const Ends ends = ReadEnds(*line, "stop line");
    signal.line_from_world = ends.from_world;
    signal.line_to_world = ends.to_world;
  } else {
    signal.line_to_world = {kUnusable, kUnusable};
  }
  const bool has_heading = section.Has("heading_deg");
  signal.travel_rad = ReadHeading(section);
  if (has_heading) CheckCrosses(section, signal);
  signal.green_s = section.NumberOr(signal.green_s, "green_s", {1, 3600, "s"});
  signal.yellow_s = section.NumberOr(signal.yellow_s, "yellow_s", {1, 60, "s"});
  signal.red_s = section.NumberOr(signal.red_s, "red_s", {1, 3600, "s"});
  signal.offset_s = section.NumberOr(signal.offset_s, "offset_s", {0, 86400, "s"});
  return signal;
}

}  // namespace giveway
