#include "services/report/picture_marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "services/types/math/math.h"

namespace giveway {

namespace {

const VehicleOptions* Find(const Scenario& scenario, VehicleId id) {
  const auto found = std::find_if(scenario.vehicles.begin(), scenario.vehicles.end(),
                                  [id](const VehicleOptions& v) { return v.id == id; });
  return found == scenario.vehicles.end() ? nullptr : &*found;
}

const VehicleOptions& NearestSpawn(const Scenario& scenario, Vec2 place_world) {
  const auto distance_m = [&](const VehicleOptions& spawn) {
    return Norm(spawn.start_world.position_world - place_world);
  };
  return *std::min_element(
      scenario.spawns.begin(), scenario.spawns.end(),
      [&](const auto& a, const auto& b) { return distance_m(a) < distance_m(b); });
}

}  // namespace

Scenario WithJoined(const Scenario& scenario, const std::vector<Track>& tracks) {
  Scenario shown = scenario;
  if (scenario.spawns.empty()) return shown;
  for (const Track& track : tracks) {
    const std::vector<const Truth*> truths = Drawable(track);
    if (truths.empty() || Find(shown, track.vehicle) != nullptr) continue;
    const Vec2 first_world = truths.front()->world_from_body.position_world;
    shown.vehicles.push_back(NearestSpawn(scenario, first_world));
    shown.vehicles.back().id = track.vehicle;
  }
  std::sort(shown.vehicles.begin(), shown.vehicles.end(),
            [](const VehicleOptions& a, const VehicleOptions& b) { return a.id < b.id; });
  return shown;
}

std::string ColourOf(const Scenario& scenario, VehicleId vehicle) {
  constexpr std::array<const char*, 7> kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                "#b58900", "#56b4e9", "#6a3d9a"};
  std::size_t index = 0;
  while (index < scenario.vehicles.size() && scenario.vehicles[index].id != vehicle) ++index;
  return index == scenario.vehicles.size() ? "#777777" : kColours[index % kColours.size()];
}

RobotModel ProfileOf(const Scenario& scenario, VehicleId vehicle) {
  const VehicleOptions* found = Find(scenario, vehicle);
  return found == nullptr ? RobotModel{} : found->profile;
}

double BodyPixels(const Canvas& canvas, const Scenario& scenario, VehicleId vehicle) {
  return canvas.Pixels(ProfileOf(scenario, vehicle).body_radius_m);
}

std::vector<const Truth*> Drawable(const Track& track) {
  std::vector<const Truth*> truths;
  for (const Truth& truth : track.truths) {
    const Vec2 p = truth.world_from_body.position_world;
    if (truth.present && std::isfinite(p.x + p.y) && std::isfinite(truth.time_s)) {
      truths.push_back(&truth);
    }
  }
  return truths;
}

std::optional<Pose> PoseAt(const std::vector<Track>& tracks, VehicleId vehicle, double time_s) {
  std::optional<Pose> pose;
  for (const Track& track : tracks) {
    if (track.vehicle != vehicle) continue;
    for (const Truth* truth : Drawable(track)) {
      if (truth->time_s <= time_s + 1e-6) pose = truth->world_from_body;
    }
  }
  return pose;
}

double HeadingAt(const Scenario& scenario, const std::vector<Track>& tracks, VehicleId vehicle,
                 double time_s) {
  if (const auto pose = PoseAt(tracks, vehicle, time_s)) return pose->heading_rad;
  const VehicleOptions* found = Find(scenario, vehicle);
  return found == nullptr ? 0 : found->start_world.heading_rad;
}

void DrawBox(Canvas* canvas, const Pose& world_from_box, Vec2 half_m, std::string_view attributes) {
  const auto corner = [&](double x, double y) {
    return canvas->At(ToWorld(world_from_box, {x * half_m.x, y * half_m.y}));
  };
  const Pixel first = corner(1, 1);
  canvas->Path({first, corner(-1, 1), corner(-1, -1), corner(1, -1), first, corner(-1, 1)},
               attributes);
}

void DrawBody(Canvas* canvas, const RobotModel& profile, const Pose& world_from_body,
              std::string_view attributes) {
  const double radius_px = canvas->Pixels(profile.body_radius_m);
  constexpr double kSmallest_px = 3;  // as a disc it is still seen
  if (profile.shape == BodyShape::kDisc || radius_px < kSmallest_px) {
    canvas->Circle(canvas->At(world_from_body.position_world), radius_px, attributes);
  } else {
    DrawBox(canvas, world_from_body, profile.box_half_m, attributes);
  }
}

void DrawHeading(Canvas* canvas, const RobotModel& profile, const Pose& world_from_body,
                 std::string_view attributes) {
  const double front_m =
      profile.shape == BodyShape::kBox ? profile.box_half_m.x : profile.body_radius_m;
  canvas->Line(canvas->At(world_from_body.position_world),
               canvas->At(ToWorld(world_from_body, {front_m, 0})), attributes);
}

namespace {

constexpr double kTickEverySeconds = 2;
constexpr const char* kContactColour = "#c00000";

void Cross(Canvas* canvas, Pixel at, double arm, const std::string& colour) {
  const std::string style =
      fmt::format("stroke=\"{}\" stroke-width=\"3.5\" stroke-linecap=\"round\"", colour);
  canvas->Line({at.x - arm, at.y - arm}, {at.x + arm, at.y + arm}, style);
  canvas->Line({at.x - arm, at.y + arm}, {at.x + arm, at.y - arm}, style);
}

void DrawTick(Canvas* canvas, Pixel before, Pixel at, const std::string& colour) {
  const double length = Distance(before, at);
  if (length < 1e-9) return;
  const Pixel across{(before.y - at.y) / length * 5, (at.x - before.x) / length * 5};
  canvas->Line({at.x - across.x, at.y - across.y}, {at.x + across.x, at.y + across.y},
               fmt::format("stroke=\"{}\" stroke-width=\"2\"", colour));
}

// The number is to the right of the driving direction.
void DrawTickTime(Canvas* canvas, Pixel before, Pixel at, double time_s) {
  const double length = Distance(before, at);
  if (length < 1e-9) return;
  const Pixel number{at.x + (before.y - at.y) / length * 14,
                     at.y + (at.x - before.x) / length * 14};
  canvas->Text({number.x, number.y + 3.5}, fmt::format("{:.0f}", time_s), "class=\"time middle\"");
  canvas->KeepClear(number);
}

// Ticks that would stand on each other, as those of a halted vehicle, are left out.
void DrawTicks(Canvas* canvas, const std::vector<const Truth*>& truths, const std::string& colour) {
  Pixel last_tick{-1e9, 0};
  Pixel last_time{-1e9, 0};
  double next_s = kTickEverySeconds;
  for (std::size_t i = 1; i < truths.size(); ++i) {
    if (truths[i]->time_s < next_s - 1e-6) continue;
    const Pixel before = canvas->At(truths[i - 1]->world_from_body.position_world);
    const Pixel at = canvas->At(truths[i]->world_from_body.position_world);
    const double time_s =
        std::floor((truths[i]->time_s + 1e-6) / kTickEverySeconds) * kTickEverySeconds;
    next_s = time_s + kTickEverySeconds;
    if (Distance(at, last_tick) < 7) continue;
    DrawTick(canvas, before, at, colour);
    last_tick = at;
    if (Distance(at, last_time) < 28) continue;
    DrawTickTime(canvas, before, at, time_s);
    last_time = at;
  }
}

double EndOf(const std::vector<WorldEvent>& events, std::size_t from) {
  double last_s = events[from].time_s;
  for (std::size_t i = from + 1; i < events.size(); ++i) {
    last_s = std::max(last_s, events[i].time_s);
    if (events[i].kind == EventKind::kResumed && events[i].vehicle == events[from].vehicle) {
      return events[i].time_s;
    }
  }
  return last_s;
}

}  // namespace

void DrawStartsAndGoals(Canvas* canvas, const Scenario& scenario) {
  for (const VehicleOptions& vehicle : scenario.vehicles) {
    const std::string colour = ColourOf(scenario, vehicle.id);
    const Pixel start = canvas->At(vehicle.start_world.position_world);
    const double body = BodyPixels(*canvas, scenario, vehicle.id);
    DrawBody(canvas, vehicle.profile, vehicle.start_world,
             fmt::format("fill=\"#fff\" stroke=\"{}\" stroke-width=\"2\"", colour));
    DrawHeading(canvas, vehicle.profile, vehicle.start_world,
                fmt::format("stroke=\"{}\" stroke-width=\"2\"", colour));
    canvas->Label(start, body, fmt::format("{}", Number(vehicle.id)),
                  fmt::format("style=\"fill:{};font-size:14px\"", colour));
    if (!vehicle.goal.set) continue;
    const Pixel goal = canvas->At(vehicle.goal.at_world);
    const double ring = std::max(canvas->Pixels(vehicle.goal.radius_m), 8.0);
    canvas->Circle(goal, ring,
                   fmt::format("fill=\"{0}\" fill-opacity=\"0.12\" stroke=\"{0}\" "
                               "stroke-width=\"2\" stroke-dasharray=\"4 3\"",
                               colour));
    canvas->Circle(goal, 2.5, fmt::format("fill=\"{}\"", colour));
  }
}

void KeepLabelsOff(Canvas* canvas, const Track& track) {
  Pixel last{-1e9, 0};
  for (const Truth* truth : Drawable(track)) {
    const Pixel point = canvas->At(truth->world_from_body.position_world);
    if (Distance(point, last) < 4) continue;
    canvas->KeepClear(point);
    last = point;
  }
}

void DrawTrack(Canvas* canvas, const Track& track, const std::string& colour) {
  const std::vector<const Truth*> truths = Drawable(track);
  std::vector<Pixel> points;
  for (const Truth* truth : truths) {
    const Pixel point = canvas->At(truth->world_from_body.position_world);
    if (!points.empty() && Distance(points.back(), point) < 0.5 && truth != truths.back()) continue;
    points.push_back(point);
  }
  canvas->Path(points, fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"2.5\" "
                                   "stroke-linejoin=\"round\" stroke-linecap=\"round\"",
                                   colour));
  DrawTicks(canvas, truths, colour);
  if (!points.empty()) canvas->Circle(points.back(), 4.5, fmt::format("fill=\"{}\"", colour));
}

void DrawClosest(Canvas* canvas, const Scenario& scenario, const std::vector<Track>& tracks,
                 const std::vector<WorldEvent>& events) {
  for (const WorldEvent& event : events) {
    if (event.kind != EventKind::kClosest || !std::isfinite(event.value)) continue;
    const Pixel a = canvas->At(event.position_world);
    const Pixel b = canvas->At(event.other_position_world);
    const auto body = [&](Vec2 at_world, VehicleId id) {
      DrawBody(canvas, ProfileOf(scenario, id),
               {at_world, HeadingAt(scenario, tracks, id, event.time_s)},
               fmt::format("fill=\"{0}\" fill-opacity=\"0.10\" stroke=\"{0}\" "
                           "stroke-opacity=\"0.7\" stroke-width=\"1.5\" "
                           "stroke-dasharray=\"2 3\"",
                           ColourOf(scenario, id)));
    };
    body(event.position_world, event.vehicle);
    body(event.other_position_world, event.other);
    canvas->Line(a, b, "stroke=\"#222\" stroke-width=\"1.5\" stroke-dasharray=\"5 4\"");
    for (int i = 0; i <= 100; ++i) {
      canvas->KeepClear({a.x + (b.x - a.x) * i / 100, a.y + (b.y - a.y) * i / 100});
    }
    canvas->Label({(a.x + b.x) / 2, (a.y + b.y) / 2}, 4,
                  fmt::format("closest {:.2f} m", event.value), "style=\"fill:#222\"");
  }
}

void DrawHalts(Canvas* canvas, const Scenario& scenario, const std::vector<Track>& tracks,
               const std::vector<WorldEvent>& events) {
  for (std::size_t i = 0; i < events.size(); ++i) {
    const WorldEvent& event = events[i];
    if (event.kind != EventKind::kHalted) continue;
    const std::string colour = ColourOf(scenario, event.vehicle);
    const Pixel at = canvas->At(event.position_world);
    const double body = BodyPixels(*canvas, scenario, event.vehicle);
    DrawBody(canvas, ProfileOf(scenario, event.vehicle),
             {event.position_world, HeadingAt(scenario, tracks, event.vehicle, event.time_s)},
             fmt::format("fill=\"{0}\" fill-opacity=\"0.28\" stroke=\"{0}\" "
                         "stroke-width=\"2\"",
                         colour));
    const double halted_s = EndOf(events, i) - event.time_s;
    if (!std::isfinite(halted_s)) continue;
    canvas->Label(at, body, fmt::format("{} halted {:.1f} s", Number(event.vehicle), halted_s),
                  fmt::format("style=\"fill:{}\"", colour));
  }
}

void DrawDeaths(Canvas* canvas, const Scenario& scenario, const std::vector<Track>& tracks,
                const std::vector<WorldEvent>& events) {
  std::vector<VehicleId> drawn;  // silent first, removed later: one cross
  for (const WorldEvent& event : events) {
    if (event.kind != EventKind::kSilent && event.kind != EventKind::kRemoved) continue;
    if (std::find(drawn.begin(), drawn.end(), event.vehicle) != drawn.end()) continue;
    // The world says when, not where: it took away what it no longer hears.
    const auto place = PoseAt(tracks, event.vehicle, event.time_s);
    if (!place) continue;
    drawn.push_back(event.vehicle);
    const std::string colour = ColourOf(scenario, event.vehicle);
    const Pixel at = canvas->At(place->position_world);
    const double body = BodyPixels(*canvas, scenario, event.vehicle);
    DrawBody(canvas, ProfileOf(scenario, event.vehicle), *place,
             fmt::format("fill=\"#777\" fill-opacity=\"0.18\" stroke=\"{}\" "
                         "stroke-width=\"1.5\"",
                         colour));
    Cross(canvas, at, std::max(body * 0.55, 6.0), colour);
    canvas->Label(
        at, body,
        fmt::format("{} {} at {:.1f} s", Number(event.vehicle),
                    event.kind == EventKind::kSilent ? "fell silent" : "removed", event.time_s),
        fmt::format("style=\"fill:{}\"", colour));
  }
}

void DrawContacts(Canvas* canvas, const std::vector<WorldEvent>& events) {
  for (const WorldEvent& event : events) {
    if (event.kind != EventKind::kContact) continue;
    // Of a wall, the other position is the point that was touched.
    const Vec2 middle = event.other == kNoVehicle
                            ? event.other_position_world
                            : 0.5 * (event.position_world + event.other_position_world);
    const Pixel at = canvas->At(middle);
    canvas->Circle(at, 11,
                   fmt::format("fill=\"#fff\" fill-opacity=\"0.8\" stroke=\"{}\" "
                               "stroke-width=\"2.5\"",
                               kContactColour));
    Cross(canvas, at, 4.5, kContactColour);
    canvas->Label(at, 12, fmt::format("contact at {:.1f} s", event.time_s),
                  fmt::format("style=\"fill:{}\"", kContactColour));
  }
}

namespace {

constexpr const char* kRouteStyle =
    "fill=\"none\" stroke=\"#9a6b3f\" stroke-width=\"1.5\" stroke-dasharray=\"2 4\" "
    "stroke-linecap=\"round\"";
constexpr const char* kLeafStyle = "stroke=\"#a0522d\" stroke-width=\"4\" stroke-dasharray=\"8 3\"";

// An open arrow head that points from `from` towards `to`, its tip at `tip`.
void Arrow(Canvas* canvas, Pixel from, Pixel to, Pixel tip, std::string_view attributes) {
  const double length = Distance(from, to);
  if (!(length > 1e-9)) return;
  const Pixel ahead{(to.x - from.x) / length, (to.y - from.y) / length};
  const auto wing = [&](double side) {
    return Pixel{tip.x - 6 * ahead.x - side * 4 * ahead.y,
                 tip.y - 6 * ahead.y + side * 4 * ahead.x};
  };
  canvas->Path({wing(1), tip, wing(-1)}, attributes);
}

void DrawRoute(Canvas* canvas, const Obstacle& obstacle) {
  std::vector<Pixel> points{canvas->At(obstacle.start_world.position_world)};
  for (const Vec2 waypoint : obstacle.waypoints_world) points.push_back(canvas->At(waypoint));
  if (obstacle.loop) points.push_back(points.front());
  canvas->Path(points, kRouteStyle);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Pixel a = points[i - 1];
    const Pixel b = points[i];
    for (int k = 0; k <= 20; ++k) {
      canvas->KeepClear({a.x + (b.x - a.x) * k / 20, a.y + (b.y - a.y) * k / 20});
    }
    if (obstacle.loop && Distance(a, b) > 30) {
      Arrow(canvas, a, b, {(a.x + b.x) / 2, (a.y + b.y) / 2},
            "fill=\"none\" stroke=\"#9a6b3f\" stroke-width=\"1.5\"");
    } else {
      canvas->Circle(b, 2.5, "fill=\"#9a6b3f\"");
    }
  }
}

void DrawShape(Canvas* canvas, const Obstacle& obstacle) {
  const bool moves = !obstacle.waypoints_world.empty();
  const std::string style =
      fmt::format("fill=\"{0}\" fill-opacity=\"0.35\" stroke=\"{0}\" stroke-width=\"1.5\"",
                  moves ? "#9a6b3f" : "#5f6670");
  RobotModel body;
  body.shape = obstacle.shape;
  body.body_radius_m = obstacle.radius_m;
  body.box_half_m = obstacle.box_half_m;
  DrawBody(canvas, body, obstacle.start_world, style);
  if (moves) {
    canvas->Label(canvas->At(obstacle.start_world.position_world),
                  canvas->Pixels(obstacle.radius_m), fmt::format("{:.2g} m/s", obstacle.speed_m_s),
                  "style=\"fill:#7a5230;font-weight:400\"");
  }
}

void DrawObstacle(Canvas* canvas, const Obstacle& obstacle) {
  DrawRoute(canvas, obstacle);
  DrawShape(canvas, obstacle);
}

void DrawHead(Canvas* canvas, Pixel at) {
  canvas->Rectangle({at.x - 5, at.y - 13}, 10, 26, "rx=\"3\" fill=\"#2b2f33\"");
  constexpr std::array<const char*, 3> kLamps{"#e5484d", "#f5c518", "#30a46c"};
  for (std::size_t i = 0; i < kLamps.size(); ++i) {
    canvas->Circle({at.x, at.y - 8 + 8 * static_cast<double>(i)}, 3,
                   fmt::format("fill=\"{}\"", kLamps[i]));
  }
}

void DrawSignal(Canvas* canvas, const SignalPlan& signal) {
  const Pixel a = canvas->At(signal.line_from_world);
  const Pixel b = canvas->At(signal.line_to_world);
  canvas->Line(a, b, "stroke=\"#2b2f33\" stroke-width=\"3\"");
  const Pixel travel{std::cos(signal.travel_rad), -std::sin(signal.travel_rad)};
  const Pixel middle{(a.x + b.x) / 2, (a.y + b.y) / 2};
  const Pixel tip{middle.x + 9 * travel.x, middle.y + 9 * travel.y};
  Arrow(canvas, middle, tip, tip, "fill=\"none\" stroke=\"#2b2f33\" stroke-width=\"2\"");
  // The head stands by the end that traffic has on its right.
  const bool a_is_right = (a.x - b.x) * -travel.y + (a.y - b.y) * travel.x > 0;
  const Pixel end = a_is_right ? a : b;
  const double length = Distance(a, b);
  if (!(length > 1e-9)) return;
  const Pixel head{end.x + (end.x - middle.x) / length * 40,
                   end.y + (end.y - middle.y) / length * 40};
  DrawHead(canvas, head);
  for (const double y : {-10.0, 0.0, 10.0}) {
    canvas->KeepClear({head.x, head.y + y});
    canvas->KeepClear({head.x + 16, head.y + y});
  }
  canvas->Text({head.x + 8, head.y + 4}, fmt::format("s{}", Number(signal.id)), "class=\"time\"");
}

void DrawSpawn(Canvas* canvas, const VehicleOptions& spawn) {
  DrawBody(canvas, spawn.profile, spawn.start_world,
           "fill=\"#fff\" stroke=\"#888\" stroke-width=\"1.5\" stroke-dasharray=\"3 3\"");
  DrawHeading(canvas, spawn.profile, spawn.start_world, "stroke=\"#888\" stroke-width=\"1.5\"");
}

}  // namespace

void DrawDoor(Canvas* canvas, Pixel from, Pixel to) {
  canvas->Line(from, to, "stroke=\"#fff\" stroke-width=\"6\"");
  canvas->Line(from, to, kLeafStyle);
  const double length = Distance(from, to);
  if (!(length > 1e-9)) return;
  const Pixel across{(to.y - from.y) / length * 6, (from.x - to.x) / length * 6};
  for (const Pixel jamb : {from, to}) {
    canvas->Line({jamb.x - across.x, jamb.y - across.y}, {jamb.x + across.x, jamb.y + across.y},
                 "stroke=\"#3c4043\" stroke-width=\"3\"");
  }
}

void DrawOneLane(Canvas* canvas, Pixel from, Pixel to, double width) {
  canvas->Line(from, to,
               fmt::format("stroke=\"#f5c518\" stroke-opacity=\"0.3\" stroke-width=\"{:.1f}\" "
                           "stroke-linecap=\"round\"",
                           width));
}

void DrawPlace(Canvas* canvas, const Scenario& scenario) {
  for (const OneLane& lane : scenario.one_lanes) {
    DrawOneLane(canvas, canvas->At(lane.from_world), canvas->At(lane.to_world),
                canvas->Pixels(lane.width_m));
  }
  for (const Wall& wall : scenario.walls) {
    canvas->Line(canvas->At(wall.from_world), canvas->At(wall.to_world),
                 "stroke=\"#3c4043\" stroke-width=\"5\" stroke-linecap=\"round\"");
  }
  for (const Door& door : scenario.doors) {
    DrawDoor(canvas, canvas->At(door.from_world), canvas->At(door.to_world));
  }
  for (const Obstacle& obstacle : scenario.obstacles) DrawObstacle(canvas, obstacle);
  for (const VehicleOptions& spawn : scenario.spawns) DrawSpawn(canvas, spawn);
  for (const SignalPlan& signal : scenario.signals) DrawSignal(canvas, signal);
}

}  // namespace giveway
