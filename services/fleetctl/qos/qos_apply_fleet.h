// Which processes of a running fleet take orders, and what each of them runs with.
#pragma once

#include <map>
#include <vector>

#include "services/fleetctl/qos/admin_client.h"
#include "services/fleetctl/qos/qos_apply_options.h"
#include "services/types/admin.h"

namespace giveway::fleetctl {

struct FleetAnswers {
  std::vector<VehicleId> targets;            // the targets of the request; the canary first
  std::vector<VehicleId> not_administrable;  // vehicles that are received and take no orders
  std::map<VehicleId, AdminAnswer> answers;  // by every vehicle that does, targets or not
};

// Asks every process. Returns 0, or the exit code after a message on stderr if a target does not
// answer.
int AskFleet(const QosApplyOptions& options, AdminClient* client, FleetAnswers* fleet);

}  // namespace giveway::fleetctl
