// The bodies of a picture of a run: whose they are, where they were, and their outlines.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/app/picture.h"
#include "services/app/picture_canvas.h"

namespace giveway::app {

// The scenario with the vehicles that joined it among its vehicles, each as the spawn place nearest
// to where it was first seen.
Scenario WithJoined(const Scenario& scenario, const std::vector<Track>& tracks);

// Tells vehicles apart also for the colour-blind (Okabe and Ito 2008); repeats after seven.
std::string ColourOf(const Scenario& scenario, VehicleId vehicle);
// A vehicle that is not in the scenario has the default profile.
VehicleProfile ProfileOf(const Scenario& scenario, VehicleId vehicle);
// The disc that holds the body.
double BodyPixels(const Canvas& canvas, const Scenario& scenario, VehicleId vehicle);

// What of a track can be drawn.
std::vector<const Truth*> Drawable(const Track& track);
// Where the vehicle was seen last up to that moment.
std::optional<Pose> PoseAt(const std::vector<Track>& tracks, VehicleId vehicle, double time_s);
// The same, and the start's heading where it was not seen.
double HeadingAt(const Scenario& scenario, const std::vector<Track>& tracks, VehicleId vehicle,
                 double time_s);

void DrawBox(Canvas* canvas, const Pose& world_from_box, Vec2 half_m, std::string_view attributes);
void DrawBody(Canvas* canvas, const VehicleProfile& profile, const Pose& world_from_body,
              std::string_view attributes);
// A line from the axle centre to the front.
void DrawHeading(Canvas* canvas, const VehicleProfile& profile, const Pose& world_from_body,
                 std::string_view attributes);

}  // namespace giveway::app
