// What is to go wrong with the packets a process hears, and what did. Values; services/link does
// it.
//
// Every decision is drawn from a seed. An impairment without a rule impairs nothing and costs
// nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/types/ids.h"
#include "services/types/time.h"

namespace giveway {

// Nothing is heard in [from_s, to_s), counted from the start signal; before it there is no
// blackout.
struct Blackout {
  double from_s = 0;
  double to_s = 0;

  friend constexpr bool operator==(const Blackout&, const Blackout&) = default;
};

// The senders that a rule applies to. A process is known as a vehicle or as the world once
// discovery has shown what it writes; only rules for any sender apply to what it sent until then.
enum class ImpairedSender : std::uint8_t { kAnyone, kVehicles, kWorld, kOneVehicle };

// Probabilities are per packet, in [0, 1], and independent of each other.
struct ImpairmentRule {
  ImpairedSender from = ImpairedSender::kAnyone;
  VehicleId from_vehicle = kNoVehicle;  // of kOneVehicle
  VehicleId to_vehicle = kNoVehicle;    // the receiver; kNoVehicle: every vehicle
  double loss = 0;
  // Gilbert-Elliott: a share of the time is bad and loses packets with probability burst_loss. A
  // bad time lasts burst_length packets on average.
  double burst = 0;         // share; 0: never bad
  double burst_length = 5;  // packets; at least 1
  double burst_loss = 1;
  double delay_s = 0;
  double jitter_s = 0;  // at most the delay: uniform in delay -+ jitter
  double reorder = 0;   // held back by reorder_by_s more, so that later ones overtake it
  double reorder_by_s = 0.075;
  double duplicate = 0;  // the second copy has a delay of its own
  double corrupt = 0;    // one bit of it, any, is turned round
  // A token bucket: what exceeds it is dropped. The packet that empties it still gets through.
  double rate_bytes_s = 0;  // 0: no limit
  double rate_burst_bytes = 8192;
  std::vector<Blackout> blackouts;
  // Holds in [from_s, to_s) only, counted from the start signal. Absent: from ever, for ever; with
  // from_s it does not hold before that signal.
  std::optional<double> from_s;
  std::optional<double> to_s;

  friend bool operator==(const ImpairmentRule&, const ImpairmentRule&) = default;
};

struct Impairment {
  std::optional<std::uint32_t> seed;  // absent: the scenario's
  // Of those that fit a packet the last counts: write the general one first.
  std::vector<ImpairmentRule> rules;
  // What the rules' times count from, of a process that joins a run late. Absent: the start
  // signal, once it is heard.
  std::optional<SteadyTime> started;

  friend bool operator==(const Impairment&, const Impairment&) = default;
};

// What was injected. Every packet from another process is counted once among passed and the drops:
//   packets = passed + Dropped().
// All others say what else happened to passed ones.
struct ImpairmentCounters {
  std::uint64_t packets = 0;
  std::uint64_t bytes = 0;  // of all packets
  std::uint64_t passed = 0;
  std::uint64_t passed_bytes = 0;  // without second copies
  std::uint64_t dropped_blackout = 0;
  std::uint64_t dropped_rate = 0;
  std::uint64_t dropped_loss = 0;
  std::uint64_t dropped_burst = 0;
  std::uint64_t delayed = 0;
  std::uint64_t held_back = 0;  // to be overtaken
  std::uint64_t reordered = 0;  // due before one from the same sender that came earlier
  std::uint64_t duplicated = 0;
  std::uint64_t corrupted = 0;
  std::uint64_t metered = 0;  // held against a limited rate, passed by it or dropped
  // Passed, but never handed on: too many were in flight, or the process ended first.
  std::uint64_t abandoned = 0;

  constexpr std::uint64_t Dropped() const {
    return dropped_blackout + dropped_rate + dropped_loss + dropped_burst;
  }
  ImpairmentCounters& operator+=(const ImpairmentCounters& more);
};

}  // namespace giveway
