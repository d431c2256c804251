// What travels besides beacons, ranges and commands: joining, the roster, the truth for observers,
// events of the run, and a vehicle's own report of itself.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "services/types/counters.h"
#include "services/types/decision.h"
#include "services/types/figures/beacon_account.h"
#include "services/types/figures/drive_figures.h"
#include "services/types/figures/packet_counters.h"
#include "services/types/ids.h"
#include "services/types/impairment.h"
#include "services/types/math/pose.h"
#include "services/types/qos_event.h"
#include "services/types/range_scan.h"
#include "services/types/task_progress.h"

namespace giveway {

// 128 bits as good as random: names one try to join, whatever id is asked for. Public.
using SessionId = std::array<std::uint32_t, 4>;

struct JoinRequest {
  SessionId session{};
  VehicleId wanted = kNoVehicle;  // kNoVehicle asks for any free id
  bool leaving = false;           // gives the id back and takes the body away
  SessionId secret{};             // that the session is made of (services/auth); 0: none
};

struct RosterEntry {
  SessionId session{};
  VehicleId vehicle = kNoVehicle;
  bool accepted = false;
  bool waiting = false;  // not accepted yet, but may be later: the world keeps the request
  std::string reason;    // why not, or why the run ended; empty otherwise
  WorldEpoch epoch = kNoEpoch;
  Pose start_world;     // where the body was at `tick`: start, spawn or checkpoint pose, or driving
  Tick tick = kNoTick;  // the world's last one as the entry was made
  WheelAngles counted;  // by the body's encoders at `tick`
  TaskProgress task;    // as the vehicle said it last with a command; nothing for a new body
  std::uint32_t spawn = 0;  // the scenario's spawn place it drives by, counted from 1; 0: its own
  RunState run_state = RunState::kWaiting;
  std::uint32_t fleet_size = 0;  // vehicles the scenario waits for
};

// Ground truth of one vehicle at one tick. For observers only; a vehicle never reads it.
struct Truth {
  VehicleId vehicle = kNoVehicle;
  WorldEpoch epoch = kNoEpoch;
  Tick tick = kNoTick;
  double time_s = 0;  // since the start signal; negative before it
  Pose world_from_body;
  WheelSpeeds wheels;
  double forward_m_s = 0;
  bool present = true;  // false once the body was removed
  bool arrived = false;
};

enum class EventKind : std::uint8_t {
  kStarted,   // the run starts; value: fleet size
  kHalted,    // vehicle stood still to give way to other; text: the rule that started it
  kResumed,   // vehicle moves again after a halt, or has left the goal it stood in
  kArrived,   // vehicle stands in its goal; value: seconds since the start
  kContact,   // vehicle and other touch; text where other is no vehicle: wall, obstacle or door
  kClosest,   // at the end: the closest approach; value: shell-to-shell metres
  kFaultDue,  // a planned fault is due now; text: "kill"; value: the signal, if any
  kSilent,    // the world hears no command of vehicle any more
  kRemoved,   // the body of a silent vehicle was taken away
  kJoined,    // vehicle was put on its start pose while the run was in progress
  kLeft,      // vehicle sent a leave notice; its body was taken away
  kEnded,     // text: why; the verdict follows
  kVerdict,   // passed when value is 1; text: reason
  // A fault of a schedule starts or ends in the world, of vehicle (kNoVehicle: of all); text: kind,
  // number and rule: "sonar_stuck 3 of flaky_sonar".
  kFaultBegan,
  kFaultOver,
};

struct WorldEvent {
  std::uint32_t seq = 0;  // 1, 2, 3 … within an epoch
  EventKind kind = EventKind::kStarted;
  WorldEpoch epoch = kNoEpoch;
  Tick tick = kNoTick;
  double time_s = 0;
  VehicleId vehicle = kNoVehicle;
  VehicleId other = kNoVehicle;
  Vec2 position_world;        // of vehicle
  Vec2 other_position_world;  // of other
  double value = 0;           // meaning by kind
  std::string text;
};

// The world's own figures of a finished run.
struct RunFigures {
  WorldEpoch epoch = kNoEpoch;
  bool passed = false;
  std::string reason;
  std::uint32_t contacts = 0;
  std::optional<double> min_separation_m;
  std::optional<double> time_to_clear_s;
  std::optional<double> reaction_p50_ms;
  std::optional<double> reaction_p99_ms;
  std::optional<double> reaction_max_ms;
  std::uint32_t reactions = 0;
  std::uint32_t ticks = 0;
  std::uint32_t tick_overruns = 0;
  std::uint64_t state_hash = 0;  // of the final world state
};

// A vehicle's report of itself.
struct VehicleStatus {
  VehicleId vehicle = kNoVehicle;
  WorldEpoch epoch = kNoEpoch;
  Tick tick = kNoTick;
  Decision decision;
  VehicleId gives_way_to = kNoVehicle;
  double forward_m_s = 0;
  std::optional<double> nearest_echo_m;
  std::uint32_t peers_heard = 0;  // with a fresh beacon
  BeaconCounters beacons;
  TrustCounters trust;
  std::uint32_t beacons_superseded = 0;  // overwritten in the reader before they were drained
  QosCounters qos;
  VehicleId last_deadline_missed = kNoVehicle;
  VehicleId last_liveliness_lost = kNoVehicle;
  // The last event of all kinds, and the vehicle it was about; empty before the first.
  std::optional<QosEventKind> last_event;
  VehicleId last_event_about = kNoVehicle;
  std::uint32_t last_rejected_id = 0;  // id claimed by the last refused beacon
  double step_p99_us = 0;              // processor time of Vehicle::Step, of the last 1000
  double loop_max_ms = 0;              // longest time from scan to command so far
  // QoS of the beacon endpoints as the library resolved it, milliseconds.
  double beacon_deadline_offered_ms = 0;
  double beacon_deadline_requested_ms = 0;
  double beacon_lease_ms = 0;
  bool final = false;  // the last one of this process
  // Of what it hears; without bytes, abandoned and reordered, which do not travel. All 0 where
  // nothing is impaired.
  ImpairmentCounters impaired;
  DriveFigures timing;  // of this process, in the run
  PacketCounters packets;
  RefusedSamples refused;
  AccountSums departed;                     // all writers that have left
  ReportedAccounts accounts;                // of the writers that are there
  std::optional<std::uint64_t> heap_bytes;  // in use, as its allocator counts it; above 0
};

}  // namespace giveway
