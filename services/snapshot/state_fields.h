// Which fields a brain's state consists of, in the order of their declaration: recording_fields.h
// for what only a brain has. A struct that gains or loses a field no longer compiles here.
#pragma once

#include <new>
#include <span>

#include "services/recording/recording_fields.h"
#include "services/snapshot/pose_state_fields.h"
#include "services/vehicle/vehicle.h"

namespace giveway {

void Visit(auto& fields, Is<Twist> auto& twist) {
  auto& [forward, turn] = twist;
  fields(forward, turn);
}

void Visit(auto& fields, Is<CachedHeading> auto& known) {
  auto& [heading, forward] = known;
  fields(heading, forward);
}

void Visit(auto& fields, Is<CachedBearing> auto& known) {
  auto& [direction, heading] = known;
  fields(direction, heading);
}

void Visit(auto& fields, Is<OwnDisplacement> auto& displacement) {
  auto& [driven, turned] = displacement;
  fields(driven, turned);
}

void Visit(auto& fields, Is<SensorView> auto& view) {
  auto& [kind, range, tick, echo_tick, echo_before, missed, closing, streak, own,
         echo_displacement] = view;
  fields(kind, range, tick, echo_tick, echo_before, missed, closing, streak, own,
         echo_displacement);
}

void Visit(auto& fields, Is<Encounter> auto& encounter) {
  auto& [active, holds, clears, lost, released, entered, lost_at, lost_wait] = encounter;
  fields(active, holds, clears, lost, released, entered, lost_at, lost_wait);
}

void Visit(auto& fields, Is<SonarDoubt> auto& doubt) {
  auto& [shown_by, ticks] = doubt;
  fields(shown_by, ticks);
}

void Visit(auto& fields, Is<PeerTrust> auto& trust) {
  auto& [ever_doubted, doubted_at, missing, standing, closing] = trust;
  fields(ever_doubted, doubted_at, missing, standing, closing);
}

void Visit(auto& fields, Is<Peer> auto& peer) {
  auto& [id, boot_epoch, writer, last_seq, waiting_count, spoke, rival_spoke, received, known,
         rivalled, deadline_missed, liveliness_lost, left, out_of_reach, encounter, trust,
         stated_heading, beacon, waiting, waiting_received] = peer;
  fields(id, boot_epoch, writer, last_seq, waiting_count, spoke, rival_spoke, received, known,
         rivalled, deadline_missed, liveliness_lost, left, out_of_reach, encounter, trust,
         stated_heading, beacon, waiting, waiting_received);
}

template <typename Scan>
void Visit(auto& fields, HeldScan<Scan>& held) {
  auto& [scan, taken, pose, speed] = held;
  fields(scan, taken, pose, speed);
}
template <typename Scan>
void Visit(auto& fields, const HeldScan<Scan>& held) {
  auto& [scan, taken, pose, speed] = held;
  fields(scan, taken, pose, speed);
}

void Visit(auto& fields, Is<SeenObjects> auto& seen) {
  auto& [radar, lidar, camera] = seen;
  fields(radar, lidar, camera);
}

void Visit(auto& fields, Is<LastHeard> auto& last) {
  auto& [vehicle, wheels, received] = last;
  fields(vehicle, wheels, received);
}

void Visit(auto& fields, Is<BeaconCounters> auto& counters) {
  auto& [sent, taken, accepted, not_heard, lost, not_finite, out_of_range, crc, replayed, own,
         wrong_name, duplicate_id, wrong_epoch, table_full] = counters;
  fields(sent, taken, accepted, not_heard, lost, not_finite, out_of_range, crc, replayed, own,
         wrong_name, duplicate_id, wrong_epoch, table_full);
}

void Visit(auto& fields, Is<QosCounters> auto& counters) {
  auto& [deadline_missed, liveliness_lost, incompatible, matched, unmatched] = counters;
  fields(deadline_missed, liveliness_lost, incompatible, matched, unmatched);
}

void Visit(auto& fields, Is<TrustCounters> auto& counters) {
  auto& [without_echo, without_beacon, closing, jumps, speeds] = counters;
  fields(without_echo, without_beacon, closing, jumps, speeds);
}

// Of those that keep their members to themselves.
struct StateFields {
  static void Of(auto& fields, Is<Odometry> auto& odometry) {
    auto& [pose, heading, covariance] = odometry;
    fields(pose, heading, covariance);
  }
  static void Of(auto& fields, Is<RangeView> auto& view) {
    auto& [sensors, echoes, spoke, spoke_tick, displacement, taken, any] = view;
    fields(sensors, echoes, spoke, spoke_tick, displacement, taken, any);
  }
  // The cells row by row: which hold something, and what. Into an empty grid.
  static void Of(auto& fields, Is<ObstacleGrid> auto& grid) {
    auto& [cells, some, at, heading, unsure, faded, fired, active] = grid;
    fields(some, at, heading, unsure, faded, fired, active);
    constexpr std::uint32_t kSide = ObstacleGrid::kSide;
    for (std::uint32_t row = 0; row < kSide; ++row) {
      for (std::uint32_t column = 0; column < kSide; ++column) {
        if ((some[row] >> column & 1U) != 0) fields(cells[row * kSide + column]);
      }
    }
  }
  // What a cell is looked up by.
  static Vec2 PlaceOf(const ObstacleGrid& grid) { return grid.at_grid_; }
  static std::span<const std::uint64_t> RowsOf(const ObstacleGrid& grid) { return grid.some_; }
  static std::span<const std::uint8_t> CellsOf(const ObstacleGrid& grid) { return grid.cells_; }
  // How much has come together until it next loses by it.
  static double UnsureOf(const ObstacleGrid& grid) { return grid.unsure_m2_; }
  static double FadedOf(const ObstacleGrid& grid) { return grid.faded_s_; }
  static std::span<const SensorView> SensorsOf(const RangeView& view) { return view.sensors_; }
  // As many heads as there are.
  static void Of(auto& fields, Is<SignalTable> auto& table) {
    auto& [heads, count] = table;
    fields(count);
    for (std::uint32_t i = 0; i < count && i < kMaxSignals; ++i) {
      auto& [state, heard, weighed, clears] = heads[i];
      fields(state, heard, weighed, clears);
    }
  }
  // Read into a table that has as many peers already: MakePeers.
  static void Of(auto& fields, Is<PeerTable> auto& table) {
    auto count = static_cast<std::uint32_t>(table.peers_.size());
    fields(count);
    for (auto& peer : table.peers_) fields(peer);
    fields(table.last_deadline_missed_, table.last_liveliness_lost_, table.last_rejected_);
  }
  static std::uint32_t CountOf(const SignalTable& table) { return table.count_; }
  static const SignalState& SignalOf(const SignalTable& table, std::uint32_t i) {
    return table.heads_[i].state;
  }
  static std::uint32_t SensorBitsOf(const RangeView& view) { return view.echoes_ | view.spoke_; }
  // At most kMaxPeers.
  static void MakePeers(PeerTable* table, std::uint32_t count) {
    table->peers_.assign(count, Peer{});
  }
};

// Counts the layouts; in addition to VehicleState::kVersion, which counts what the fields mean.
// What a layout has more than the one before stands at the end of the state.
enum class StateFormat : std::uint32_t {
  kFirst = 1,
  kWithPose = 2,
  kWithGrid = 3,
  kWithDoubtedHeading = 4,
  kWithWrongFixes = 5,
  kWithTimedDoubt = 6,
  kWithDoubtedSonar = 7
};
// Of a brain that has taken nothing into its obstacle grid, and to which neither fixes nor
// ultrasonics seemed wrong; of others it is one of those after it.
inline constexpr StateFormat kStateFormat = StateFormat::kWithPose;

template <typename T>
concept KeepsItsOwn = Is<T, Odometry> || Is<T, RangeView> || Is<T, ObstacleGrid> ||
    Is<T, SignalTable> || Is<T, PeerTable>;

void Visit(auto& fields, KeepsItsOwn auto& part) { StateFields::Of(fields, part); }

// In the order of format 1, which is older than the groups. What is appended to the state is led
// over apart, by the format that has it, and the grid and the doubt behind the rest where they are
// used: brain_state.cc.
void Visit(auto& fields, Is<VehicleState> auto& state) {
  auto& [published, world, motion, route, progress, waiting, movers, last, sensed, heard,
         counters] = state;
  auto& [boot_epoch, seq, gives_way_to] = published;
  auto& [epoch, placed_in, tick, run_state] = world;
  auto& [odometry, pose, pose_tick, wheels, counted] = motion;
  auto& [waypoint, arrived, bearing] = route;
  auto& [nearest, no_progress_ticks, detour, detour_tick, away, away_tick, stuck, stuck_ticks] =
      progress;
  auto& [order, waited_ticks, waited, let_pass] = waiting;
  auto& [unidentified, unidentified_sensor, unidentified_since, turned_tick] = movers;
  auto& [decided_tick, decision, steer_side, blocked_by, blocked_tick] = last;
  auto& [ranges, grid, objects, doubt] = sensed;
  auto& [peers, signals, last_heard] = heard;
  auto& [scans_refused, signals_refused, beacons, qos, trust] = counters;
  static_cast<void>(grid);
  static_cast<void>(doubt);
  fields(boot_epoch, seq, epoch, tick, placed_in, run_state, odometry, pose_tick, wheels, counted,
         bearing, waypoint, arrived, order, waited_ticks, waited, let_pass, unidentified_since,
         turned_tick, decided_tick, unidentified, unidentified_sensor, decision, gives_way_to,
         blocked_by, blocked_tick, steer_side, nearest, no_progress_ticks, detour, detour_tick,
         away, away_tick, stuck, stuck_ticks, ranges, peers, signals, objects, last_heard,
         scans_refused, signals_refused, beacons, qos, trust);
  if (fields.Has(StateFormat::kWithPose)) fields(pose);
}

}  // namespace giveway
