// What the page needs besides the frames: the names behind numbers, the shape of bodies, and
// what stands in the world, which no topic carries: it comes from the scenario. Pure.
#pragma once

#include <optional>
#include <string>

#include "services/types/scenario.h"

namespace giveway {

struct SceneSource {
  std::string title;                 // "domain 7"
  std::optional<Scenario> scenario;  // none: no walls are shown
  // The process that a page is connected to: what it keeps of another one is gone. Empty: it is not
  // connected.
  std::string observer = {};
};

std::string SceneJson(const SceneSource& source);

}  // namespace giveway
