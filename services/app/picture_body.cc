#include "services/app/picture_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace giveway::app {
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

VehicleProfile ProfileOf(const Scenario& scenario, VehicleId vehicle) {
  const VehicleOptions* found = Find(scenario, vehicle);
  return found == nullptr ? VehicleProfile{} : found->profile;
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

void DrawBody(Canvas* canvas, const VehicleProfile& profile, const Pose& world_from_body,
              std::string_view attributes) {
  const double radius_px = canvas->Pixels(profile.body_radius_m);
  constexpr double kSmallest_px = 3;  // as a disc it is still seen
  if (profile.shape == BodyShape::kDisc || radius_px < kSmallest_px) {
    canvas->Circle(canvas->At(world_from_body.position_world), radius_px, attributes);
  } else {
    DrawBox(canvas, world_from_body, profile.box_half_m, attributes);
  }
}

void DrawHeading(Canvas* canvas, const VehicleProfile& profile, const Pose& world_from_body,
                 std::string_view attributes) {
  const double front_m =
      profile.shape == BodyShape::kBox ? profile.box_half_m.x : profile.body_radius_m;
  canvas->Line(canvas->At(world_from_body.position_world),
               canvas->At(ToWorld(world_from_body, {front_m, 0})), attributes);
}

}  // namespace giveway::app
