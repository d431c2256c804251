// The marks of a picture of a run: bodies, their outlines and paths, the place they drive in, and
// what happened. One function each; later ones lie on top of earlier ones.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/report/picture_canvas.h"
#include "services/report/track.h"
#include "services/types/scenario.h"

namespace giveway {

// The scenario with the vehicles that joined it among its vehicles, each as the spawn place nearest
// to where it was first seen.
Scenario WithJoined(const Scenario& scenario, const std::vector<Track>& tracks);

// Distinguishes vehicles also for the colour-blind (Okabe and Ito 2008); repeats after seven.
std::string ColourOf(const Scenario& scenario, VehicleId vehicle);
// A vehicle that is not in the scenario has the default profile.
RobotModel ProfileOf(const Scenario& scenario, VehicleId vehicle);
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
void DrawBody(Canvas* canvas, const RobotModel& profile, const Pose& world_from_body,
              std::string_view attributes);
// A line from the axle centre to the front.
void DrawHeading(Canvas* canvas, const RobotModel& profile, const Pose& world_from_body,
                 std::string_view attributes);

void DrawGrid(Canvas* canvas);
void DrawScaleBar(Canvas* canvas);
// Walls, doors, obstacles with their routes, spawn places, stop lines with their heads.
void DrawPlace(Canvas* canvas, const Scenario& scenario);

void DrawDoor(Canvas* canvas, Pixel from, Pixel to);
void DrawOneLane(Canvas* canvas, Pixel from, Pixel to, double width);

// Start: the body, hollow, with its heading. Goal: its circle with a dot.
void DrawStartsAndGoals(Canvas* canvas, const Scenario& scenario);
void KeepLabelsOff(Canvas* canvas, const Track& track);
// The path with a tick every 2 s and the seconds written next to some.
void DrawTrack(Canvas* canvas, const Track& track, const std::string& colour);
// Both bodies and the distance between them.
void DrawClosest(Canvas* canvas, const Scenario& scenario, const std::vector<Track>& tracks,
                 const std::vector<WorldEvent>& events);
void DrawHalts(Canvas* canvas, const Scenario& scenario, const std::vector<Track>& tracks,
               const std::vector<WorldEvent>& events);
// A cross where a vehicle fell silent or was taken away.
void DrawDeaths(Canvas* canvas, const Scenario& scenario, const std::vector<Track>& tracks,
                const std::vector<WorldEvent>& events);
void DrawContacts(Canvas* canvas, const std::vector<WorldEvent>& events);

// What the colours and marks mean: its height and itself, below the plot.
double LegendHeight(const Scenario& scenario);
void DrawLegend(Canvas* canvas, const Scenario& scenario);

}  // namespace giveway
