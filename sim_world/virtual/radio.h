// The radio of the virtual fleet, with the link's reader behind it: which vehicle receives which
// beacon when, and which events the middleware would report of silent peers. Every draw is a hash
// of seed, pair and tick, so that it depends on no other draw. Knows true positions, no brains.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "services/types/beacon.h"
#include "services/types/qos_event.h"
#include "services/types/scenario.h"
#include "sim_world/geometry/grid.h"
#include "sim_world/virtual/radio_rules.h"
#include "sim_world/virtual/virtual_plan.h"

namespace giveway::sim {

// The guarantees of the beacon topic, as the reader sees them: the default profile's, and with
// ticks longer than its 50 ms no fewer periods. So a single lost beacon is no missed deadline.
inline constexpr Nanoseconds kDeadlineRequested{150'000'000};
inline constexpr std::int64_t kDeadlinePeriods = 3;
inline constexpr Nanoseconds kLivelinessLease{250'000'000};
inline constexpr std::int64_t kLeasePeriods = 5;

// A vehicle's place at the tick of reception.
struct RadioPlace {
  Vec2 position_world;
  bool on_air = false;  // its process runs and its body is there
};

class Radio {
 public:
  // Vehicles are numbered as in the scenario.
  Radio(const Scenario& scenario, const RadioSettings& settings, std::uint64_t seed);

  // What a vehicle sent in answer to `tick`. At most one beacon per vehicle and tick.
  void Transmit(std::size_t sender, Tick tick, const Beacon& beacon);
  // Each vehicle's place at the tick now being received, time_s after the start signal.
  void BeginTick(Tick now, double time_s, std::span<const RadioPlace> places);
  // Appends what the vehicle receives in this tick: of one sender in order of arrival.
  void Hear(std::size_t receiver, std::vector<ReceivedBeacon>* heard);
  // Appends what the middleware reports in this tick of peers it heard before; call after Hear.
  void Notice(std::size_t receiver, std::vector<QosEvent>* events);
  // Of the rules of the settings; see there.
  bool HasActed(std::uint64_t draws) const { return rules_.HasActed(draws); }

 private:
  // Of an ordered pair.
  struct Pair {
    std::uint32_t heard_tick = 0;
    std::uint32_t burst_tick = 0;  // of `bad`
    bool bad = false;
    bool listed = false;  // in the receiver's list of those to expect beacons of
    bool deadline_missed = false;
    bool stated_far = false;  // heard from outside the listened-to radius, and still outside
  };
  struct SentBeacon {
    ReceivedBeacon beacon;
    Tick tick = kNoTick;
  };

  struct Fate {
    std::uint32_t due = 1;  // ticks after it was sent
    bool twice = false;
  };

  double SquaredDistance(std::size_t receiver, std::size_t sender) const;
  bool IsInReach(std::size_t receiver, std::size_t sender) const;
  bool KnowsItIsFar(std::size_t receiver, std::size_t sender, Pair* pair) const;
  bool IsLinkBad(std::size_t receiver, std::size_t sender, Pair* pair) const;
  bool IsLost(std::size_t receiver, std::size_t sender, std::uint64_t draw, Pair* pair) const;
  Fate FateOf(std::uint64_t draw) const;
  bool SurvivesRules(std::size_t receiver, std::size_t sender, std::uint32_t ticks, Fate* fate);
  bool HasJustSent(std::size_t sender) const;
  void HearSender(std::size_t receiver, std::size_t sender, std::vector<ReceivedBeacon>* heard);
  void MarkHeard(std::size_t receiver, std::size_t sender, Pair* pair);
  bool HasLeft(std::size_t receiver, std::size_t sender, const Pair& pair) const;
  void NoticeSilence(std::size_t sender, Pair* pair, std::vector<QosEvent>* events) const;
  void MarkBlackouts(double time_s);
  std::uint64_t Draw(std::size_t receiver, std::size_t sender, std::uint32_t tick,
                     std::uint64_t salt) const;

  RadioSettings settings_;
  std::uint64_t seed_;
  Nanoseconds period_;
  std::size_t count_;
  std::uint32_t shortest_ticks_;  // from sent to received
  std::uint32_t longest_ticks_;
  RadioRules rules_;
  std::uint32_t most_ticks_;  // longest_ticks_, and what rules add
  std::uint32_t kept_ticks_;  // of history
  bool varies_;               // beacons differ in transit time
  bool draws_;                // anything is random
  Nanoseconds deadline_;
  Nanoseconds lease_;
  std::uint32_t deadline_ticks_;
  std::uint32_t lease_ticks_;
  std::vector<VehicleId> ids_;
  std::vector<double> reach_m_;   // by receiver: heard at all
  std::vector<double> listen_m_;  // by receiver: listened to
  double widest_reach_m_ = 0;
  std::vector<SentBeacon> history_;            // [sender * kept_ticks_ + tick % kept_ticks_]
  std::vector<Pair> pairs_;                    // [receiver * count_ + sender]
  std::vector<std::uint32_t> expected_;        // [receiver * count_ + …] senders
  std::vector<std::uint32_t> expected_count_;  // of each receiver
  std::vector<RadioPlace> places_;
  std::vector<Vec2> positions_world_;
  std::vector<std::uint8_t> blacked_out_;
  Grid grid_;
  Tick now_ = kNoTick;
  SteadyTime heard_at_{0};
};

}  // namespace giveway::sim
