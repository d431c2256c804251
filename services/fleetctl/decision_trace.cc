#include "services/fleetctl/decision_trace.h"

#include <fmt/format.h>

#include <iterator>

namespace giveway::fleetctl {

void AppendLine(const TraceLine& line, const Outputs& said, std::string* text) {
  const Decision& decision = said.command.decision;
  fmt::format_to(
      std::back_inserter(*text),
      "{}\t{:.2f}\t{}\t{:.4f}\t{:.4f}\t{:.4f}\t{:.4f}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\n",
      Number(line.tick), line.time_s, Number(line.vehicle), line.world_from_body.position_world.x,
      line.world_from_body.position_world.y, line.world_from_body.heading_rad, line.forward_m_s,
      Name(decision.mode), Name(decision.rule), Number(decision.peer), decision.sensor,
      Number(said.beacon.gives_way_to), said.beacon.order.waited_ticks, line.arrived ? 1 : 0);
}

}  // namespace giveway::fleetctl
