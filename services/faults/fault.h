// What goes wrong in a run, when, to which target and for how long: faults as values, and the table
// of all kinds. The table names the actor that carries each out; nothing here does. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "services/types/ids.h"

namespace giveway::faults {

// Each kind by the word that fault files and reports have for it: ToString.
enum class Kind : std::uint8_t {
  // The supervisor makes these happen to processes.
  kKill,                  // SIGKILL; it does not come back
  kRestart,               // SIGKILL, and a new process after for_s
  kPause,                 // SIGSTOP for for_s
  kHang,                  // its deciding thread stands for for_s, the others continue
  kSlow,                  // gets `share` of the processor
  kMemoryLimit,           // may use `bytes` more than it does
  kDescriptorLimit,       // may open `count` more files than it has
  kDiskFull,              // what it records cannot be written
  kLogReaderStops,        // no process reads its stderr
  kClockStep,             // its system clock jumps by `offset_s`
  kQosMismatch,           // restarts with a set that does not match the others'
  kQosApply,              // an order over DDS gives it the set `qos`
  kDuplicateId,           // a second process with its id
  kChurn,                 // `count` processes join and are killed, one after the other
  kSharedMemoryGone,      // what is in /dev/shm is deleted while it is used
  kSharedMemoryLeftOver,  // segments of dead processes lie there
  kSharedMemorySmall,     // /dev/shm is full
  // At the receiver: rules of services/types/impairment.h.
  kLoss,
  kBurst,
  kDelay,
  kReorder,
  kDuplicate,
  kCorrupt,
  kRate,
  kOneWayCut,  // the target does not hear `from`
  kPartition,  // the target and all others do not hear each other
  kFlapping,   // as kPartition, on and off every period_s
  // The world, so in virtual time too.
  kSonarOff,           // no echo
  kSonarStuck,         // the ranges of when it started
  kSonarGarbage,       // any range
  kSonarWrong,         // ranges times `factor`
  kSonarSlow,          // new ranges each period_s only
  kSonarDelayed,       // ranges of delay_s ago
  kSonarIntermittent,  // each scan is without echoes with `probability`
  kMotorWeak,          // wheels reach `factor` of what was commanded
  kMotorStuck,         // wheels continue as they turned when it started
  kEncoderWrong,       // encoders count `factor` of what the wheels turn
  kPoseFixLost,        // no pose fixes
  kPoseFixWrong,       // each with `probability` off by `factor` of its standard deviations
  // A program of the tests.
  kSpoofed,    // beacons under the target's id
  kReplayed,   // the target's earlier beacons
  kFlooded,    // rate_hz packets a second
  kMalformed,  // packets no library would send
};
inline constexpr std::size_t kKinds = static_cast<std::size_t>(Kind::kMalformed) + 1;

// The actor that carries a kind out.
enum class Actor : std::uint8_t { kSupervisor, kHearer, kWorld, kAttacker };

// The target.
struct Target {
  enum class What : std::uint8_t { kVehicle, kWorld, kDiscoveryServer, kAll };
  What what = What::kVehicle;
  VehicleId vehicle = kNoVehicle;  // of kVehicle

  friend constexpr bool operator==(const Target&, const Target&) = default;
};

// A profile set without a file: what the fleet was started with, the deadlines that readers request
// doubled. A single vehicle can take it while it drives.
inline constexpr std::string_view kPatientReaders = "patient_readers";

// Parameters of a kind besides target and times. Absent: the kind's own default, set by Expand.
struct Parameters {
  std::optional<double> probability;   // 0 to 1
  std::optional<double> share;         // of a processor, above 0, to 1
  std::optional<double> factor;        // 0 to 10
  std::optional<double> delay_s;       // 0 to 10
  std::optional<double> period_s;      // 0.05 to 600
  std::optional<double> offset_s;      // -86400 to 86400
  std::optional<double> rate_hz;       // 1 to 100000
  std::optional<double> bytes;         // 1 to 1e12; of kRate a second
  std::optional<std::uint32_t> count;  // 1 to 100000
  std::optional<VehicleId> from;       // the sender the target does not hear; absent: no other
  std::string qos;                     // name or file of a profile set, or kPatientReaders

  friend bool operator==(const Parameters&, const Parameters&) = default;
};

// One fault of the list that real and virtual runs carry out.
struct Fault {
  std::string rule;       // that it came from, by name; unique in its file
  std::uint32_t nth = 0;  // of that rule, from 0
  double at_s = 0;        // since the start signal
  double for_s = 0;       // 0: of a kind that takes no time
  Kind kind = Kind::kKill;
  Target target;
  Parameters parameters;

  double EndsAt_s() const { return at_s + for_s; }
  friend bool operator==(const Fault&, const Fault&) = default;
};

// By at_s, then rule, then nth.
using Schedule = std::vector<Fault>;

std::string_view ToString(Kind kind);
std::optional<Kind> KindOf(std::string_view word);
Actor ActorOf(Kind kind);

}  // namespace giveway::faults
