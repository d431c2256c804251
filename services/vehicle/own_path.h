// The path a vehicle is on: along its route, to its goal, or round a crowd.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "services/types/vehicle_options.h"
#include "services/vehicle/estimation/signal_table.h"
#include "services/vehicle/situation/situation.h"
#include "services/vehicle/vehicle_state.h"

namespace giveway {

// The straight path to the next waypoint or the goal; straight on without either.
OwnCourse UpdatePath(const OwnPose& pose, const VehicleOptions& options, RouteProgress* route,
                     GoalProgress* progress);

// Straight parts of the route past its next waypoint, the first `count`.
struct LegsBeyond {
  std::array<Leg, 4> of;
  std::size_t count = 0;

  std::span<const Leg> All() const { return {of.data(), count}; }
};

// Those on which the vehicle continues in about the same direction, up to reach_m past the
// waypoint. It does not stop there: what it must stop for, it has to know before.
LegsBeyond FindLegsBeyond(const OwnCourse& course, std::uint32_t waypoint,
                          const VehicleOptions& options, double reach_m);

// Where steering round obstacles makes no progress, the path is planned on a map of them. `last`:
// what the step before decided.
Escape Detour(const OwnView& s, const PeersNow& near, const LastStep& last, GoalProgress* progress);

}  // namespace giveway
