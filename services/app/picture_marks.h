// The marks of a picture of a run, one function each. Later ones lie on top of earlier ones.
#pragma once

#include <string>
#include <vector>

#include "services/app/picture.h"
#include "services/app/picture_canvas.h"

namespace giveway::app {

// Tells vehicles apart also for the colour-blind (Okabe and Ito 2008); repeats after seven.
std::string ColourOf(const Scenario& scenario, VehicleId vehicle);

void DrawGrid(Canvas* canvas);
void DrawScaleBar(Canvas* canvas);
void DrawWalls(Canvas* canvas, const Scenario& scenario);
// Start: the body, hollow, with its heading. Goal: its circle with a dot.
void DrawStartsAndGoals(Canvas* canvas, const Scenario& scenario);
void KeepLabelsOff(Canvas* canvas, const Track& track);
// The path with a tick every 2 s and the seconds written beside some.
void DrawTrack(Canvas* canvas, const Track& track, const std::string& colour);
// Both bodies and the distance between them.
void DrawClosest(Canvas* canvas, const Scenario& scenario, const std::vector<WorldEvent>& events);
void DrawHalts(Canvas* canvas, const Scenario& scenario, const std::vector<WorldEvent>& events);
// A cross where a vehicle fell silent or was taken away.
void DrawDeaths(Canvas* canvas, const Scenario& scenario, const std::vector<Track>& tracks,
                const std::vector<WorldEvent>& events);
void DrawContacts(Canvas* canvas, const std::vector<WorldEvent>& events);

}  // namespace giveway::app
