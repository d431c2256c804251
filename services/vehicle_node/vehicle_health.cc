#include "services/vehicle_node/vehicle_health.h"

#include "services/link/fastdds/packets_of_process.h"
#include "services/types/math/pose.h"

namespace giveway {

void VehicleHealthReporter::OnStarting(const std::string& waits_for) {
  VehicleHealth& now = service_.Now();
  now.loop.stage = HealthStage::kStarting;
  now.waits_for = ShortText(waits_for);
  service_.Publish();
}

void VehicleHealthReporter::OnJoining(const std::string& waits_for) {
  VehicleHealth& now = service_.Now();
  now.loop.stage = HealthStage::kJoining;
  now.waits_for = ShortText(waits_for);
  service_.Publish();
}

void VehicleHealthReporter::OnPlaced(VehicleId id, Nanoseconds ranges_age_limit) {
  VehicleHealth& now = service_.Now();
  now.loop.stage = HealthStage::kUnderWay;
  now.status.vehicle = id;
  now.ranges_age_limit = ranges_age_limit;
  ++now.placements;
  service_.Publish();
}

void VehicleHealthReporter::OnTick(const link::Taken& taken,
                                   const link::VehicleLinkCounters& counters,
                                   const RosterEntry& place, SteadyTime woke) {
  VehicleHealth& now = service_.Now();
  if (taken.inputs.scan) now.scanned = woke;
  now.late_scans = counters.ranges_skipped;
  now.run_state = place.run_state;
  now.fleet_size = place.fleet_size;
  now.matched_peers = counters.matched_peers;
  now.write_failures = counters.write_failures;
  now.ranges_deadline_missed = counters.ranges_deadline_missed;
  now.packets = link::PacketsOfProcess();
  service_.Publish();
}

void VehicleHealthReporter::OnStatus(const VehicleStatus& status, const VehicleState& brain) {
  VehicleHealth& now = service_.Now();
  now.status = status;
  now.pose_sigma_m = SigmaPosition(PromisedCovariance(brain.motion.odometry, brain.motion.pose));
  now.fixes_used = brain.motion.pose.fixes_used;
  now.fixes_refused = brain.motion.pose.fixes_refused;
}

void VehicleHealthReporter::OnLeaving() {
  service_.Now().loop.stage = HealthStage::kLeaving;
  service_.Publish();
}

}  // namespace giveway
