// Which fields a recording keeps of each struct, in the order of idl/recording.proto. An archive is
// led over them: `fields(a, b, c)`. A struct that gains or loses a field no longer compiles here,
// so that nothing a brain reads is ever left out of a recording by oversight.
#pragma once

#include <concepts>
#include <type_traits>

#include "services/recording/recording.h"
#include "services/recording/resumed.h"

namespace giveway {

template <typename T, typename U>
concept Is = std::same_as<std::remove_const_t<T>, U>;

void Visit(auto& fields, Is<Vec2> auto& v) {
  auto& [x, y] = v;
  fields(x, y);
}

void Visit(auto& fields, Is<Pose> auto& pose) {
  auto& [position, heading] = pose;
  fields(position, heading);
}

void Visit(auto& fields, Is<PoseCovariance> auto& covariance) {
  auto& [xx, xy, yy, xh, yh, hh] = covariance;
  fields(xx, xy, yy, xh, yh, hh);
}

void Visit(auto& fields, Is<WheelSpeeds> auto& wheels) {
  auto& [left, right] = wheels;
  fields(left, right);
}

void Visit(auto& fields, Is<WheelAngles> auto& angles) {
  auto& [left, right] = angles;
  fields(left, right);
}

void Visit(auto& fields, Is<DriveGeometry> auto& drive) {
  auto& [wheel_radius, axle] = drive;
  fields(wheel_radius, axle);
}

void Visit(auto& fields, Is<Goal> auto& goal) {
  auto& [set, at, radius] = goal;
  fields(set, at, radius);
}

void Visit(auto& fields, Is<Route> auto& route) {
  auto& [waypoints, count, loop, radius] = route;
  fields(waypoints, count, loop, radius);
}

void Visit(auto& fields, Is<BraitenbergWeights> auto& weights) {
  auto& [base, near_gate, far_gate, left, right] = weights;
  fields(base, near_gate, far_gate, left, right);
}

void Visit(auto& fields, Is<SensorMount> auto& mount) {
  auto& [position, bearing, enabled] = mount;
  fields(position, bearing, enabled);
}

void Visit(auto& fields, Is<PoseFixModel> auto& model) {
  auto& [every, sigma, sigma_heading, dropout] = model;
  fields(every, sigma, sigma_heading, dropout);
}

void Visit(auto& fields, Is<WheelErrors> auto& errors) {
  auto& [diameter, axle] = errors;
  fields(diameter, axle);
}

void Visit(auto& fields, Is<RobotModel> auto& profile) {
  auto& [drive, shape, body_radius, box_half, max_speed, max_turn, acceleration, deceleration, slip,
         encoder_noise, half_angle, max_range, sonar, radar, lidar, camera, pose_fix, wheel_error,
         pose_limit] = profile;
  fields(drive, shape, body_radius, box_half, max_speed, max_turn, acceleration, deceleration, slip,
         encoder_noise, half_angle, max_range, sonar, radar, lidar, camera, pose_fix, wheel_error,
         pose_limit);
}

void Visit(auto& fields, Is<OneLane> auto& lane) {
  auto& [from, to, width] = lane;
  fields(from, to, width);
}

void Visit(auto& fields, Is<VehicleOptions> auto& options) {
  auto& [id, behaviour, profile, cruise, goal, route, start, braitenberg, tick_period, gate_enter,
         gate_exit, metric, emission_radius, beacon_age_limit, ranges_age_limit, sonar_refresh,
         sonar_noise, ageing_limit, one_lanes, silent_body_stays] = options;
  fields(id, behaviour, profile, cruise, goal, route, start, braitenberg, tick_period, gate_enter,
         gate_exit, metric, emission_radius, beacon_age_limit, ranges_age_limit, sonar_refresh,
         sonar_noise, ageing_limit, one_lanes, silent_body_stays);
}

void Visit(auto& fields, Is<PriorityKey> auto& key) {
  auto& [waited_ticks, speed_bucket, vehicle] = key;
  fields(waited_ticks, speed_bucket, vehicle);
}

void Visit(auto& fields, Is<Beacon> auto& beacon) {
  auto& [vehicle, boot_epoch, seq, epoch, tick, wheels, cruise, pose, covariance, body_radius,
         drive, acceleration, deceleration, toward, mode, rule, gives_way_to, blocked_by, order] =
      beacon;
  fields(vehicle, boot_epoch, seq, epoch, tick, wheels, cruise, pose, covariance, body_radius,
         drive, acceleration, deceleration, toward, mode, rule, gives_way_to, blocked_by, order);
}

void Visit(auto& fields, Is<ReceivedBeacon> auto& received) {
  // A replay checks the ranges itself; no brain reads the arrival.
  auto& [beacon, at, crc_valid, name_valid, writer, in_range, arrival] = received;
  fields(beacon, at, crc_valid, name_valid, writer);
}

void Visit(auto& fields, Is<QosEvent> auto& event) {
  auto& [kind, vehicle, at] = event;
  fields(kind, vehicle, at);
}

void Visit(auto& fields, Is<RangeReading> auto& reading) {
  auto& [kind, range, tick, fired_before] = reading;
  fields(kind, range, tick, fired_before);
}

void Visit(auto& fields, Is<RangeScan> auto& scan) {
  auto& [vehicle, epoch, tick, run_state, wheels, counted, readings] = scan;
  fields(vehicle, epoch, tick, run_state, wheels, counted, readings);
}

void Visit(auto& fields, Is<RadarDetection> auto& detection) {
  auto& [range, bearing, range_rate, long_range] = detection;
  fields(range, bearing, range_rate, long_range);
}

void Visit(auto& fields, Is<RadarScan> auto& scan) {
  auto& [vehicle, epoch, tick, count, detections] = scan;
  fields(vehicle, epoch, tick, count, detections);
}

void Visit(auto& fields, Is<LidarScan> auto& scan) {
  auto& [vehicle, epoch, tick, echo, range] = scan;
  fields(vehicle, epoch, tick, echo, range);
}

void Visit(auto& fields, Is<CameraObject> auto& object) {
  auto& [seen_class, bearing, half_width] = object;
  fields(seen_class, bearing, half_width);
}

void Visit(auto& fields, Is<CameraScan> auto& scan) {
  auto& [vehicle, epoch, tick, count, objects] = scan;
  fields(vehicle, epoch, tick, count, objects);
}

void Visit(auto& fields, Is<SignalState> auto& signal) {
  auto& [id, epoch, tick, line_from, line_to, travel, phase, to_change] = signal;
  fields(id, epoch, tick, line_from, line_to, travel, phase, to_change);
}

void Visit(auto& fields, Is<TaskProgress> auto& task) {
  auto& [waypoint, waited_ticks] = task;
  fields(waypoint, waited_ticks);
}

void Visit(auto& fields, Is<RosterEntry> auto& entry) {
  auto& [session, vehicle, accepted, waiting, reason, epoch, start, tick, counted, task, spawn,
         run_state, fleet_size] = entry;
  fields(session, vehicle, accepted, waiting, reason, epoch, start, tick, counted, task, spawn,
         run_state, fleet_size);
}

void Visit(auto& fields, Is<Handover> auto& handover) {
  auto& [epoch, tick, counted, pose, covariance, task] = handover;
  fields(epoch, tick, counted, pose, covariance, task);
}

void Visit(auto& fields, Is<PoseFix> auto& fix) {
  auto& [pose, sigma_position, sigma_heading, vehicle, epoch, tick] = fix;
  fields(pose, sigma_position, sigma_heading, vehicle, epoch, tick);
}

void Visit(auto& fields, Is<Decision> auto& decision) {
  auto& [mode, rule, peer, sensor, cause_tick] = decision;
  fields(mode, rule, peer, sensor, cause_tick);
}

// The count of matched peers is the loop's, not the brain's.
void Visit(auto& fields, Is<MotorCommand> auto& command) {
  auto& [vehicle, epoch, tick, target, decision, changed, matched_peers, task] = command;
  static_cast<void>(matched_peers);
  fields(vehicle, epoch, tick, target, decision, changed, task);
}

void Visit(auto& fields, Is<Outputs> auto& outputs) {
  auto& [command, beacon, changed] = outputs;
  fields(command, beacon, changed);
}

void Visit(auto& fields, Is<RecordedLife> auto& life) {
  auto& [boot_epoch, options, recorded_by, handover] = life;
  fields(boot_epoch, options, recorded_by, handover);
}

void Visit(auto& fields, Is<Resumed> auto& resumed) {
  auto& [session, order, handover] = resumed;
  fields(session, order, handover);
}

void Visit(auto& fields, Is<RecordedReseat> auto& reseat) {
  auto& [options] = reseat;
  fields(options);
}

void Visit(auto& fields, Is<RecordedStep> auto& step) {
  auto& [now, scan, beacons, events, radar, lidar, camera, signals, roster, fix, leaving, halting,
         outputs, hash] = step;
  fields(now, scan, beacons, events, radar, lidar, camera, signals, roster, fix, leaving, halting,
         outputs, hash);
}

void Visit(auto& fields, Is<RecordedEnd> auto& end) {
  auto& [steps, lost, failure, continues] = end;
  fields(steps, lost, failure, continues);
}

void Visit(auto& fields, Is<RecordedImage> auto& image) {
  auto& [options, recorded_by, state, hash] = image;
  fields(options, recorded_by, state, hash);
}

void Visit(auto& fields, Is<RecordedContinuation> auto& head) {
  auto& [boot_epoch, vehicle, part, steps_before] = head;
  fields(boot_epoch, vehicle, part, steps_before);
}

}  // namespace giveway
