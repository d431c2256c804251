#include "services/vehicle/estimation/last_heard.h"

namespace giveway {

// Of those heard at one time the highest id is the last: the table is in order of ids.
void HearTheLast(std::span<const Peer> peers, LastHeard* last) {
  for (const Peer& peer : peers) {
    const bool later = last->vehicle == kNoVehicle || peer.received >= last->received;
    if (peer.known && later) *last = {peer.id, peer.beacon.wheels, peer.received};
  }
}

void AddTo(const LastHeard& last, StateHash* hash) {
  if (last.vehicle == kNoVehicle) return;
  hash->Add(last.vehicle);
  hash->Add(last.wheels.left_rad_s);
  hash->Add(last.wheels.right_rad_s);
}

}  // namespace giveway
