// What a vehicle has done of its task that its body does not show. It says so with every motor
// command, the world keeps it beside the body, and a new process of the vehicle is told: without it
// a route would start again at its first waypoint.
#pragma once

#include <cstdint>

namespace giveway {

struct TaskProgress {
  std::uint32_t waypoint = 0;      // the next one of its route; their count: on to the goal
  std::uint32_t waited_ticks = 0;  // halted to give way, on the way to where it is through

  friend bool operator==(const TaskProgress&, const TaskProgress&) = default;
};

}  // namespace giveway
