// Run::Save and Run::Restore: a run's way through the end of its process. run.cc has the rest.
#include "sim_world/run.h"

namespace giveway::sim {

RunCheckpoint Run::Save() const {
  return {.epoch = epoch_,
          .started = started_,
          .ticks_run = ticks_run_,
          .faults = {faults_.States().begin(), faults_.States().end()},
          .tracks = {judge_.Tracks().begin(), judge_.Tracks().end()},
          .attendance = {attendance_.Entries().begin(), attendance_.Entries().end()},
          .world = world_.Save()};
}

bool Run::Restore(const RunCheckpoint& checkpoint, std::span<const VehicleOptions> joined) {
  for (const VehicleOptions& options : joined) world_.Join(options);
  if (!faults_.Restore(checkpoint.faults) || !world_.Restore(checkpoint.world)) return false;
  judge_.Restore(checkpoint.tracks);
  attendance_.Restore(checkpoint.attendance);
  for (const PlannedFault& fault : faults_.Lasting()) signals_.Fail(fault.signal, fault.kind);
  started_ = checkpoint.started;
  ticks_run_ = checkpoint.ticks_run;
  return true;
}

}  // namespace giveway::sim
