// The marks of a picture of a run, one function each. Later ones lie on top of earlier ones.
#pragma once

#include <string>
#include <vector>

#include "services/app/picture.h"
#include "services/app/picture_canvas.h"

namespace giveway::app {

void DrawGrid(Canvas* canvas);
void DrawScaleBar(Canvas* canvas);
// Walls, doors, obstacles with their routes, spawn places, stop lines with their heads.
void DrawPlace(Canvas* canvas, const Scenario& scenario);

void DrawDoor(Canvas* canvas, Pixel from, Pixel to);

// Start: the body, hollow, with its heading. Goal: its circle with a dot.
void DrawStartsAndGoals(Canvas* canvas, const Scenario& scenario);
void KeepLabelsOff(Canvas* canvas, const Track& track);
// The path with a tick every 2 s and the seconds written beside some.
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

}  // namespace giveway::app
