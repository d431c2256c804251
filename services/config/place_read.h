// What a scenario file says of its place: walls, obstacles, one-lane sections, doors, signal heads,
// and how its ultrasonics hear. Where bodies stand is judged elsewhere (start_rules.cc).
#pragma once

#include <optional>

#include "services/config/section.h"
#include "services/types/scenario.h"

namespace giveway {

SonarModel ReadSonar(const std::optional<Section>& section, Nanoseconds tick_period);
// VehicleOptions::sonar_refresh. In the tiers with a firing schedule a transducer fires every
// eighth slot and is heard of in a whole tick; one slot more for the listening. Else 0.
Nanoseconds SonarRefresh(const SonarModel& sonar, Nanoseconds tick_period);

Wall ReadWall(const Section& section);
Obstacle ReadObstacle(const Section& section);
OneLane ReadOneLane(const Section& section);
Door ReadDoor(const Section& section);
SignalPlan ReadSignal(const Section& section);

}  // namespace giveway
