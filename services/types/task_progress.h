// What a vehicle has done of its task that its body does not show. It says so with every motor
// command, the world keeps it with the body, and sends it to a new process of the vehicle: without
// it a route would start again at its first waypoint.
#pragma once

#include <cstdint>

namespace giveway {

struct TaskProgress {
  std::uint32_t waypoint = 0;      // the next one of its route; their count: on to the goal
  std::uint32_t waited_ticks = 0;  // halted to give way, before the conflict it is not through yet

  friend bool operator==(const TaskProgress&, const TaskProgress&) = default;
};

}  // namespace giveway
