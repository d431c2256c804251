// What stands and moves in a picture beside the vehicles.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "services/app/picture_body.h"
#include "services/app/picture_marks.h"
#include "services/types/math.h"

namespace giveway::app {
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
  VehicleProfile body;
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

void DrawPlace(Canvas* canvas, const Scenario& scenario) {
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

}  // namespace giveway::app
