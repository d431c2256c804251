#include "services/vehicle/lecture.h"

#include <algorithm>

#include "services/vehicle/decide.h"
#include "services/vehicle/peer_table.h"
#include "services/vehicle/vehicle.h"

namespace giveway {
namespace {

// left^2 + right^2: as large for one that spins or backs out as for one that drives.
double Compared(WheelSpeeds wheels) {
  return wheels.left_rad_s * wheels.left_rad_s + wheels.right_rad_s * wheels.right_rad_s;
}

// The nearest echo within the gate, of whatever it may be; -1 where there is none.
int CriticalSensor(const Situation& s) {
  int critical = -1;
  double nearest_m = s.options.gate_enter_m;
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    if (s.ranges[i].kind != Echo::kEcho || s.ranges[i].range_m >= nearest_m) continue;
    nearest_m = s.ranges[i].range_m;
    critical = static_cast<int>(i);
  }
  return critical;
}

}  // namespace

// Of those heard at one time the highest id is the last: the table is in order of ids.
void HearTheLast(std::span<const Peer> peers, LastHeard* last) {
  for (const Peer& peer : peers) {
    const bool later = last->vehicle == kNobody || peer.received >= last->received;
    if (peer.known && later) *last = {peer.id, peer.beacon.wheels, peer.received};
  }
}

void AddTo(const LastHeard& last, StateHash* hash) {
  if (last.vehicle == kNobody) return;
  hash->Add(last.vehicle);
  hash->Add(last.wheels.left_rad_s);
  hash->Add(last.wheels.right_rad_s);
}

Action AsPrinted(const Situation& s, const Action& wanted) {
  const LastHeard& peer = s.last_heard;
  const int sensor = CriticalSensor(s);
  if (sensor < 0 || Compared(s.wheels) > Compared(peer.wheels)) return wanted;
  Action copied{.target = peer.wheels};
  copied.decision = {
      .rule = Rule::kGiveWay, .peer = peer.vehicle, .sensor = sensor, .cause_tick = s.tick};
  return copied;
}

// The printed scripts look at nobody: they know neither places nor ways, only the one variable.
void Vehicle::LookAround(Situation* s) {
  if (options_.behaviour != Behaviour::kLecturePrinted) {
    NoteTurning(s);
    LookAtPeers(s);
    ListenForMovers(s);
    Detour(s);
    return;
  }
  const std::span<const Peer> peers = state_->peers.Peers();
  peers_heard_ =
      static_cast<std::uint32_t>(std::count_if(peers.begin(), peers.end(), [&](const Peer& peer) {
        return IsFresh(peer, s->now, s->tick, options_);
      }));
  HearTheLast(peers, &state_->last_heard);
  s->last_heard = state_->last_heard;
}

}  // namespace giveway
