// The rules of a radio that are active for a time: which links they cut now, and what they do to a
// beacon in transit. Counts in ticks since the start signal; every draw is a hash of the radio's
// seed, the rule, the pair and the tick in which the beacon was sent. Knows no positions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "services/types/ids.h"
#include "services/types/time.h"
#include "sim_world/virtual/virtual_plan.h"

namespace giveway::sim {

// A beacon that takes longer would be of no use, and arrives by then.
inline constexpr std::uint32_t kLongestTicks = 40;

class RadioRules {
 public:
  // Vehicles are numbered as `ids` are.
  RadioRules(std::span<const RadioRule> rules, std::span<const VehicleId> ids, std::uint64_t seed,
             Nanoseconds tick_period);

  // The most ticks by which all of them together may delay a beacon, at most kLongestTicks.
  std::uint32_t MostLate() const { return most_late_; }

  // The tick now being received, by its time since the start signal, which never decreases.
  void BeginTick(double time_s);
  // Whether any rule affects what is received now.
  bool Any() const { return !cuts_.live.empty() || !changes_.live.empty(); }

  // Of what would be received now. `speaks`: there is a beacon.
  bool IsCut(std::size_t hearer, std::size_t speaker, bool speaks);

  struct Effect {
    bool lost = false;
    bool twice = false;
    std::uint32_t late_ticks = 0;
  };
  // Of a beacon that was sent that many ticks ago, in the tick of that number.
  Effect Of(std::size_t hearer, std::size_t speaker, std::uint32_t ticks_ago,
            std::uint32_t sent_tick);
  // Whether a beacon was lost, delayed, doubled or cut off by the rule of these draws, while it has
  // a say.
  bool HasActed(std::uint64_t draws) const;

 private:
  static constexpr std::uint32_t kAnyone = 0xffffffff;
  struct Timed {
    RadioRule rule;
    std::int64_t from = 0;  // ticks since the start signal
    std::int64_t to = 0;
    std::int64_t period = 0;
    std::int64_t on = 0;  // of each period
    std::uint32_t hearer = kAnyone;
    std::uint32_t speaker = kAnyone;
    std::uint32_t late = 0;
    std::uint32_t reorder_late = 0;
    bool has_acted = false;
  };

  // Those that have a say for a while, of all in order of their start.
  struct Rules {
    std::vector<Timed> all;
    std::size_t next = 0;
    std::vector<std::uint32_t> live;
  };

  static void Follow(std::int64_t tick, std::int64_t lasting, Rules* rules);
  static bool IsOn(const Timed& timed, std::int64_t tick);
  static bool Fits(const Timed& timed, std::size_t hearer, std::size_t speaker);

  Rules cuts_;
  Rules changes_;
  std::uint64_t seed_;
  std::size_t count_;
  Nanoseconds tick_period_;
  std::uint32_t most_late_ = 0;
  std::int64_t now_ = 0;
};

}  // namespace giveway::sim
