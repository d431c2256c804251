// What goes wrong in a virtual run in addition to the scenario: faults of radio and processes.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/faults/fault.h"
#include "services/types/ids.h"
#include "services/types/time.h"

namespace giveway::sim {

// Loss in bursts (Gilbert 1960, Elliott 1963): each ordered pair has a link that is good or bad and
// changes state from tick to tick. Bad links lose `loss` of the beacons, good ones the radio's.
struct BurstLoss {
  double enter = 0;    // probability a tick that a good link turns bad; 0: no bursts
  double leave = 0.2;  // probability a tick that a bad link recovers; the mean burst is 1 / leave
  double loss = 1;     // share of beacons a bad link loses
};

// No peer receives the vehicle and it receives none.
struct Blackout {
  VehicleId vehicle = kNoVehicle;  // kNoVehicle: every vehicle
  double from_s = 0;               // since the start signal
  double to_s = 0;
};

// A radio fault for a time, on the receiver's side. Loss, delay and duplication depend on when the
// beacon was sent, a cut on when it would be received. Rules that are active at once draw
// separately, and their delays add up.
struct RadioRule {
  double from_s = 0;               // since the start signal
  double to_s = 0;                 // not any more
  VehicleId hearer = kNoVehicle;   // kNoVehicle: every vehicle
  VehicleId speaker = kNoVehicle;  // kNoVehicle: every vehicle
  bool cut = false;                // nothing of the speaker is received
  bool both_ways = false;          // of a cut: and the speaker does not receive the hearer
  double period_s = 0;            // of a cut: on for the first half of each period; 0: all the time
  double loss = 0;                // share lost, each by itself
  double burst_loss = 0;          // share lost in bursts
  std::uint32_t burst_ticks = 1;  // beacons of one burst
  Nanoseconds delay{0};           // arrives so much later
  double reorder = 0;             // share that arrives reorder_by later still, and is overtaken
  Nanoseconds reorder_by{0};
  double duplicate = 0;     // share received a second time, a tick after the first
  std::uint64_t draws = 0;  // the rule's own
};

struct RadioSettings {
  double loss = 0;  // share of beacons lost, each by itself; 0 to 1
  BurstLoss burst;
  // In transit for delay, and up to jitter more. Received at the first tick after its arrival, and
  // never at the tick it was sent.
  Nanoseconds delay{0};
  Nanoseconds jitter{0};
  double reorder = 0;       // share held back for two ticks more, so that later ones overtake them
  double duplicate = 0;     // share received a second time, a tick after the first
  bool loops_back = false;  // every vehicle receives its own beacons too
  std::vector<Blackout> blackouts;
  std::vector<RadioRule> rules;
  // The radio's own reach by true positions. Without one it reaches further than any vehicle
  // listens, as the middleware does: brains ignore what was stated from beyond their emission
  // radius.
  std::optional<double> reach_m;
};

enum class ProcessFaultKind : std::uint8_t {
  kCrash,    // silent forever; the body stays as long as the scenario says
  kPause,    // stands still for a time, then continues with everything queued
  kRestart,  // is gone for a time; then a new one continues from the pose and the progress
             // that the world sends
  kSlow,     // answers only a share of the ticks for a time, and finds the rest queued
};

struct ProcessFault {
  ProcessFaultKind kind = ProcessFaultKind::kCrash;
  VehicleId vehicle = kNoVehicle;
  double at_s = 0;     // since the start signal
  double for_s = 0.5;  // not of a crash; the world treats a second of silence as a death
  double share = 1;    // of kSlow
};

struct VirtualPlan {
  std::uint64_t seed = 0;  // of all draws here
  RadioSettings radio;
  std::vector<ProcessFault> faults;
  // In addition to these, as real runs have it; virtual_faults.h says which of it is injected.
  faults::Schedule schedule;
  // Of the invariants that are otherwise only counted: bit i for invariant i.
  std::uint32_t also_required = 0;
  // Of a place made by a generator, or what was left of one: how long it is where only one can be.
  // By it vehicles are due, and of those that share a goal one must arrive. Absent: the scenario
  // states what it expects.
  std::optional<double> through_m;
};

}  // namespace giveway::sim
