// Which mechanism must see which fault, and how soon by the profile's promise. Values only: no
// clock, no process. fleetctl stopwatch checks real fleets against it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/types/time.h"

namespace giveway::fleetctl {

enum class Fault : std::uint8_t {
  kKill,    // kill -9
  kPause,   // SIGSTOP: nothing of the process runs
  kExit,    // SIGTERM: it leaves gracefully
  kHung,    // the control loop stops, the library's threads continue
  kCut,     // no packet between it and its peers, either way
  kOneWay,  // its packets are lost, it hears its peers
};
inline constexpr std::size_t kFaults = 6;

// How a vehicle learns that a peer is gone.
enum class Mechanism : std::uint8_t {
  kBeaconAge,    // its own limit on the age of the newest beacon
  kDeadline,     // DEADLINE of the beacon reader
  kLiveliness,   // LIVELINESS of the beacon reader
  kLease,        // the participant's lease, or its end: the peer's writer is unmatched
  kLeaveNotice,  // the last beacons of a vehicle that leaves
};
inline constexpr std::size_t kMechanisms = 5;

// "one_way", "beacon_age": as on the command line and in JSON.
std::string_view Name(Fault fault);
std::string_view Name(Mechanism mechanism);
std::optional<Fault> FaultNamed(std::string_view name);

enum class Duty : std::uint8_t {
  kNone,      // must not see it
  kMust,      // must see it, within its promise
  kIfManual,  // must, unless the library asserts liveliness by itself (AUTOMATIC): then must not
  kMay,       // may or may not
};

// A row per fault, a column per mechanism. After an exit no peer is stale, because a vehicle that
// sent a leave notice is not missed; and the process is silent for a while before it is gone,
// longer than deadline and liveliness if its exit takes long.
inline constexpr std::array<std::array<Duty, kMechanisms>, kFaults> kDuties = {{
    //  beacon_age    deadline       liveliness        lease        good_bye
    {Duty::kMust, Duty::kMust, Duty::kMust, Duty::kMust, Duty::kNone},      // kill
    {Duty::kMust, Duty::kMust, Duty::kMust, Duty::kMust, Duty::kNone},      // pause
    {Duty::kNone, Duty::kMay, Duty::kMay, Duty::kMust, Duty::kMust},        // exit
    {Duty::kMust, Duty::kMust, Duty::kIfManual, Duty::kNone, Duty::kNone},  // hung
    {Duty::kMust, Duty::kMust, Duty::kMust, Duty::kMust, Duty::kNone},      // cut
    {Duty::kMust, Duty::kMust, Duty::kMust, Duty::kMust, Duty::kNone},      // one_way
}};

enum class LivelinessKind : std::uint8_t { kAutomatic, kManualByParticipant, kManualByTopic };

// From the profile and the scenario. Absent: no limit, the mechanism is off.
struct Limits {
  Nanoseconds beacon_period{0};
  Nanoseconds beacon_age{0};
  std::optional<Nanoseconds> deadline;
  std::optional<Nanoseconds> liveliness;
  LivelinessKind asserted = LivelinessKind::kManualByTopic;  // by the writer
  LivelinessKind tracked = LivelinessKind::kManualByTopic;   // by the reader
  std::optional<Nanoseconds> lease;
};

// With the liveliness kind and disabled mechanisms applied: kNone, kMust or kMay.
Duty DutyOf(Fault fault, Mechanism mechanism, const Limits& limits);

// One summand of a promise, with its reason.
struct Term {
  Nanoseconds time{0};
  std::string_view reason;
};
// Detection may take their sum and the longest pause of the machine. Empty if the mechanism is off.
std::vector<Term> Promise(Mechanism mechanism, const Limits& limits);
Nanoseconds PromisedWithin(Mechanism mechanism, const Limits& limits);  // their sum

// The matrix and the promises as text.
std::string TableText(const Limits& limits);

}  // namespace giveway::fleetctl
