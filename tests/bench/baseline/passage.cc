#include "tests/bench/baseline/passage.h"

#include <algorithm>
#include <cmath>

#include "services/types/time.h"

namespace giveway::bench {
namespace {

constexpr std::uint32_t kWordBits = 64;

bool Has(const FreeUnits& bits, std::uint32_t unit) {
  const std::uint32_t word = unit / kWordBits;
  return word < bits.size() && (bits[word] >> (unit % kWordBits) & 1U) != 0;
}

// to |= from << shift, where both are `open`: before the shift and after it.
void Spread(const FreeUnits& from, const FreeUnits& open, std::uint32_t shift, FreeUnits* to) {
  const std::uint32_t words = shift / kWordBits;
  const std::uint32_t bits = shift % kWordBits;
  std::uint64_t carried = 0;
  for (std::size_t i = 0; i + words < to->size(); ++i) {
    const std::uint64_t here = from[i] & open[i];
    (*to)[i + words] |= ((here << bits) | carried) & open[i + words];
    carried = bits == 0 ? 0 : here >> (kWordBits - bits);
  }
}

// Every place that can be reached by each step, by the speed it is reached with.
class Reach {
 public:
  Reach(const Pace& pace, const Passing& passing) : pace_(pace), passing_(passing) {
    words_ = passing.last_unit / kWordBits + 1;
    steps_.push_back(Nowhere());
    steps_.front()[0][0] = 1;
  }

  std::optional<Passage> Search() {
    for (std::uint32_t step = 1; step <= passing_.last_step; ++step) {
      Extend(step);
      if (std::optional<Passage> passage = Arrive(step)) return passage;
    }
    return std::nullopt;
  }

 private:
  using Levels = std::vector<FreeUnits>;

  Levels Nowhere() const { return Levels(pace_.top + 1, FreeUnits(words_, 0)); }
  std::uint32_t Slowest(std::uint32_t from) const {
    return from > pace_.down ? from - pace_.down : 0;
  }

  void Extend(std::uint32_t step) {
    const FreeUnits& open = passing_.free_during(step);
    steps_.push_back(Nowhere());
    const Levels& before = steps_[step - 1];
    if (step <= passing_.first_step) {
      Spread(before[0], open, 0, &steps_[step][0]);
      return;
    }
    for (std::uint32_t from = 0; from <= pace_.top; ++from) {
      for (std::uint32_t to = Slowest(from); to <= std::min(from + 1, pace_.top); ++to) {
        Spread(before[from], open, pace_.Units(from, to), &steps_[step][to]);
      }
    }
  }

  // The furthest and fastest of the states at the goal from which it can come to rest.
  std::optional<Passage> Arrive(std::uint32_t step) const {
    for (std::uint32_t unit = passing_.last_unit; unit >= passing_.arrive_unit; --unit) {
      for (std::uint32_t level = pace_.top + 1; level-- > 0;) {
        if (!Has(steps_[step][level], unit)) continue;
        Passage passage = TraceBack(step, unit, level);
        if (ComeToRest(&passage)) return passage;
      }
    }
    return std::nullopt;
  }

  // Back through the slowest predecessors, so that it is as far on as possible at any time: a
  // vehicle behind or across finds the path free sooner.
  Passage TraceBack(std::uint32_t step, std::uint32_t unit, std::uint32_t level) const {
    Passage passage = {.levels = std::vector<std::uint32_t>(step + 1, 0),
                       .units = std::vector<std::uint32_t>(step + 1, 0),
                       .arrival_step = step};
    for (; step > 0; --step) {
      passage.levels[step] = level;
      passage.units[step] = unit;
      const FreeUnits& open = passing_.free_during(step);
      const std::uint32_t fastest = std::min(level + pace_.down, pace_.top);
      for (std::uint32_t from = level > 0 ? level - 1 : 0; from <= fastest; ++from) {
        const std::uint32_t driven = pace_.Units(from, level);
        if (driven > unit || !Has(open, unit - driven)) continue;
        if (!Has(steps_[step - 1][from], unit - driven)) continue;
        unit -= driven;
        level = from;
        break;
      }
    }
    return passage;
  }

  bool ComeToRest(Passage* passage) const {
    std::uint32_t unit = passage->units.back();
    std::uint32_t step = passage->arrival_step;
    for (std::uint32_t level = passage->levels.back(); level > 0;) {
      const FreeUnits& open = passing_.free_during(++step);
      const std::uint32_t to = Slowest(level);
      const std::uint32_t reached = unit + pace_.Units(level, to);
      if (!Has(open, unit) || !Has(open, reached)) return false;
      unit = reached;
      level = to;
      passage->levels.push_back(level);
      passage->units.push_back(unit);
    }
    return passing_.may_stay(unit, step);
  }

  const Pace& pace_;
  const Passing& passing_;
  std::size_t words_;
  std::vector<Levels> steps_;
};

}  // namespace

std::uint32_t Pace::Units(std::uint32_t from, std::uint32_t to) const {
  static_assert(kTicksAStep % 2 == 1, "half a unit a tick otherwise");
  constexpr std::uint32_t kRamp = (kTicksAStep + 1) / 2;
  return (kTicksAStep - kRamp) * from + kRamp * to;
}

Pace PaceOf(const VehicleOptions& options) {
  const double tick_s = Seconds(options.tick_period);
  const double step_s = kTicksAStep * tick_s;
  const double gained_m_s = options.profile.acceleration_m_s2 * step_s;
  Pace pace;
  pace.top =
      std::max(1U, static_cast<std::uint32_t>(std::ceil(options.cruise_m_s / gained_m_s - 1e-9)));
  pace.level_m_s = options.cruise_m_s / pace.top;
  pace.down = static_cast<std::uint32_t>(
      options.profile.deceleration_m_s2 * step_s / pace.level_m_s + 1e-9);
  pace.unit_m = pace.level_m_s * tick_s;
  return pace;
}

std::optional<Passage> SoonestPassage(const Pace& pace, const Passing& passing) {
  return Reach(pace, passing).Search();
}

}  // namespace giveway::bench
