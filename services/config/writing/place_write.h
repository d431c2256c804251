// The place of a scenario as its file holds it: walls, one-lane sections, obstacles, doors, signal
// heads, ultrasonics. The reverse of place_read.h.
#pragma once

#include "services/types/scenario.h"

namespace giveway::schema {
class Point;
class Scenario;
}  // namespace giveway::schema

namespace giveway {

// The degrees to write for an angle: thousandths where they read back as the same.
double DegreesOf(double angle_rad);
void Set(Vec2 point, schema::Point* message);
void SetPlace(const Scenario& scenario, schema::Scenario* message);

}  // namespace giveway
