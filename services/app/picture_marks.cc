#include "services/app/picture_marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "services/app/picture_body.h"

namespace giveway::app {
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

// The number sits to the right of the way the vehicle drives.
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
    if (events[i].kind == EventKind::kWentOn && events[i].vehicle == events[from].vehicle) {
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
    const Vec2 middle = event.other == kNobody
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

}  // namespace giveway::app
