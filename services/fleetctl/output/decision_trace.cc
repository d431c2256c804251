#include "services/fleetctl/output/decision_trace.h"

#include <fmt/format.h>

#include <iterator>

namespace giveway::fleetctl {

void AppendLine(const TraceLine& line, const Outputs& said, std::string* text) {
  const Decision& decision = said.command.decision;
  const Beacon& beacon = said.beacon;
  fmt::format_to(std::back_inserter(*text),
                 "{}\t{:.2f}\t{}\t{:.4f}\t{:.4f}\t{:.4f}\t{:.4f}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{"
                 ":.3f}\t{:.3f}\t{}\n",
                 Number(line.tick), line.time_s, Number(line.vehicle),
                 line.world_from_body.position_world.x, line.world_from_body.position_world.y,
                 line.world_from_body.heading_rad, line.forward_m_s, Name(decision.mode),
                 Name(decision.rule), Number(decision.peer), decision.sensor,
                 Number(beacon.gives_way_to), Number(beacon.blocked_by), beacon.order.waited_ticks,
                 Number(beacon.order.vehicle), beacon.toward_world.x, beacon.toward_world.y,
                 line.arrived ? 1 : 0);
}

}  // namespace giveway::fleetctl
