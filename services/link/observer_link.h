// An observer's side: reads what the world and the vehicles publish, writes nothing.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "services/link/link_options.h"
#include "services/types/fleet_facts.h"

namespace giveway::link {

struct Observed {
  std::vector<Truth> truths;
  std::vector<WorldEvent> events;
  std::vector<VehicleStatus> statuses;
  std::vector<RosterEntry> roster;
  std::optional<RunFigures> figures;
};

class ObserverLink {
 public:
  explicit ObserverLink(const LinkOptions& options);  // Throws LinkError.
  ~ObserverLink();
  ObserverLink(const ObserverLink&) = delete;
  ObserverLink& operator=(const ObserverLink&) = delete;

  // Everything that came since the last call, each kind in order of arrival.
  Observed Take();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace giveway::link
