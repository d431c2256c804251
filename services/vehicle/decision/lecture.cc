#include "services/vehicle/decision/lecture.h"

namespace giveway {
namespace {

// left^2 + right^2: as large for one that spins or backs out as for one that drives.
double Compared(WheelSpeeds wheels) {
  return wheels.left_rad_s * wheels.left_rad_s + wheels.right_rad_s * wheels.right_rad_s;
}

// The nearest echo within the gate, of whatever it may be; -1 where there is none.
int CriticalSensor(const Situation& s) {
  int critical = -1;
  double nearest_m = s.own.options.gate_enter_m;
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    if (s.own.ranges[i].kind != Echo::kEcho || s.own.ranges[i].range_m >= nearest_m) continue;
    nearest_m = s.own.ranges[i].range_m;
    critical = static_cast<int>(i);
  }
  return critical;
}

}  // namespace

Action AsPrinted(const Situation& s, const Action& wanted) {
  const LastHeard& peer = s.last_heard;
  const int sensor = CriticalSensor(s);
  if (sensor < 0 || Compared(s.own.wheels) > Compared(peer.wheels)) return wanted;
  Action copied{.target = peer.wheels};
  copied.decision = {
      .rule = Rule::kGiveWay, .peer = peer.vehicle, .sensor = sensor, .cause_tick = s.own.tick};
  return copied;
}

}  // namespace giveway
