#include "sim_world/virtual/virtual_fleet.h"

#include <algorithm>

namespace giveway::sim {
namespace {

constexpr WorldEpoch kVirtualEpoch{1};

}  // namespace

VirtualFleet::VirtualFleet(const Scenario& scenario)
    : scenario_(scenario), run_(scenario_, kVirtualEpoch) {
  std::uint32_t boot_epoch = 1;
  for (const VehicleOptions& options : scenario_.vehicles) {
    run_.Join(options.id);
    members_.push_back({options.id, std::make_unique<Vehicle>(options, boot_epoch++), true, {}});
  }
  run_.Start();
}

// The radio: what everyone living said in the last tick.
void VirtualFleet::Deliver() {
  on_air_.clear();
  const SteadyTime now = Number(run_.Now()) * scenario_.tick_period;
  for (const Member& member : members_) {
    if (!member.alive || member.said.beacon.seq == 0) continue;
    on_air_.push_back({.beacon = member.said.beacon,
                       .received = now,
                       .crc_valid = true,
                       .name_valid = true,
                       .writer = member.said.beacon.boot_epoch});
  }
}

void VirtualFleet::Think() {
  commands_.clear();
  for (const RangeScan& scan : run_.Scans()) {
    const auto member =
        std::find_if(members_.begin(), members_.end(),
                     [&scan](const Member& candidate) { return candidate.id == scan.vehicle; });
    if (member == members_.end() || !member->alive) continue;
    // The radio does not carry a vehicle's own beacon back to it.
    const auto own = std::find_if(
        on_air_.begin(), on_air_.end(),
        [&scan](const ReceivedBeacon& heard) { return heard.beacon.vehicle == scan.vehicle; });
    if (own != on_air_.end()) std::iter_swap(own, on_air_.end() - 1);
    const std::size_t heard = on_air_.size() - (own != on_air_.end() ? 1 : 0);
    Inputs inputs;
    inputs.now = Number(scan.tick) * scenario_.tick_period;
    inputs.scan = scan;
    inputs.beacons = {on_air_.data(), heard};
    member->said = member->brain->Step(inputs);
    commands_.push_back(member->said.command);
  }
}

void VirtualFleet::CarryOutFaults() {
  for (const WorldEvent& event : run_.Events()) {
    history_.push_back(event);
    if (event.kind != EventKind::kFaultDue) continue;
    for (Member& member : members_) {
      if (member.id == event.vehicle) member.alive = false;
    }
  }
}

bool VirtualFleet::Advance() {
  run_.Advance(commands_);
  CarryOutFaults();
  Deliver();
  Think();
  return run_.State() != RunState::kEnded;
}

void VirtualFleet::Finish() {
  while (Advance()) {
  }
}

}  // namespace giveway::sim
