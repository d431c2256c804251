#include "sim_world/virtual/radio_rules.h"

#include <algorithm>
#include <cmath>

#include "services/types/math/random.h"
#include "services/types/time.h"

namespace giveway::sim {
namespace {

constexpr std::uint64_t kOfRows = 1;  // a stream separate from that of single beacons

}  // namespace

RadioRules::RadioRules(std::span<const RadioRule> rules, std::span<const VehicleId> ids,
                       std::uint64_t seed, Nanoseconds tick_period)
    : seed_(seed), count_(ids.size()), tick_period_(tick_period) {
  const auto number_of = [&](VehicleId id) {
    return id == kNoVehicle ? kAnyone
                            : static_cast<std::uint32_t>(std::ranges::find(ids, id) - ids.begin());
  };
  const auto ticks = [&](double seconds) {
    return static_cast<std::int64_t>(TicksCovering(FromSeconds(seconds), tick_period));
  };
  for (const RadioRule& rule : rules) {
    Timed timed{.rule = rule,
                .from = ticks(rule.from_s),
                .to = ticks(rule.to_s),
                .hearer = number_of(rule.hearer),
                .speaker = number_of(rule.speaker),
                .late = TicksCovering(rule.delay, tick_period),
                .reorder_late = TicksCovering(rule.reorder_by, tick_period)};
    if (rule.period_s > 0) {
      timed.period = std::max<std::int64_t>(2, ticks(rule.period_s));
      timed.on = timed.period / 2;
    }
    const std::uint32_t late =
        timed.late + (rule.reorder > 0 ? timed.reorder_late : 0) + (rule.duplicate > 0 ? 1 : 0);
    if (!rule.cut) most_late_ = std::min(kLongestTicks, most_late_ + late);
    (rule.cut ? cuts_ : changes_).all.push_back(timed);
  }
  std::ranges::stable_sort(cuts_.all, {}, &Timed::from);
  std::ranges::stable_sort(changes_.all, {}, &Timed::from);
}

bool RadioRules::IsOn(const Timed& timed, std::int64_t tick) {
  if (tick < timed.from || tick >= timed.to) return false;
  return timed.period == 0 || (tick - timed.from) % timed.period < timed.on;
}

bool RadioRules::Fits(const Timed& timed, std::size_t hearer, std::size_t speaker) {
  return (timed.hearer == kAnyone || timed.hearer == hearer) &&
         (timed.speaker == kAnyone || timed.speaker == speaker);
}

void RadioRules::Follow(std::int64_t tick, std::int64_t lasting, Rules* rules) {
  std::erase_if(rules->live, [&](std::uint32_t i) { return tick >= rules->all[i].to + lasting; });
  for (; rules->next < rules->all.size() && rules->all[rules->next].from <= tick; ++rules->next) {
    rules->live.push_back(static_cast<std::uint32_t>(rules->next));
  }
}

// What was sent under a rule may be received long after it.
void RadioRules::BeginTick(double time_s) {
  now_ = std::llround(time_s / Seconds(tick_period_));
  Follow(now_, 0, &cuts_);
  Follow(now_, kLongestTicks + 1, &changes_);
}

bool RadioRules::IsCut(std::size_t hearer, std::size_t speaker, bool speaks) {
  bool is_cut = false;
  for (const std::uint32_t i : cuts_.live) {
    Timed& cut = cuts_.all[i];
    const bool fits =
        Fits(cut, hearer, speaker) || (cut.rule.both_ways && Fits(cut, speaker, hearer));
    if (!fits || !IsOn(cut, now_)) continue;
    is_cut = true;
    cut.has_acted = cut.has_acted || speaks;
  }
  return is_cut;
}

bool RadioRules::HasActed(std::uint64_t draws) const {
  const auto has = [draws](const Rules& rules) {
    return std::ranges::any_of(rules.live, [&](std::uint32_t i) {
      return rules.all[i].rule.draws == draws && rules.all[i].has_acted;
    });
  };
  return has(cuts_) || has(changes_);
}

RadioRules::Effect RadioRules::Of(std::size_t hearer, std::size_t speaker, std::uint32_t ticks_ago,
                                  std::uint32_t sent_tick) {
  Effect effect;
  const std::uint64_t pair = hearer * count_ + speaker;
  for (const std::uint32_t i : changes_.live) {
    Timed& timed = changes_.all[i];
    const RadioRule& rule = timed.rule;
    if (!IsOn(timed, now_ - ticks_ago) || !Fits(timed, hearer, speaker)) continue;
    Random each(seed_ ^ rule.draws, pair << 32U | sent_tick);
    const bool lost = each.Uniform(0, 1) < rule.loss;
    const bool held_back = each.Uniform(0, 1) < rule.reorder;
    const bool twice = each.Uniform(0, 1) < rule.duplicate;
    Random rows(seed_ ^ rule.draws ^ kOfRows, pair << 32U | sent_tick / rule.burst_ticks);
    const bool in_row = rule.burst_loss > 0 && rows.Uniform(0, 1) < rule.burst_loss;
    effect.lost = effect.lost || lost || in_row;
    effect.twice = effect.twice || twice;
    const std::uint32_t late = timed.late + (held_back ? timed.reorder_late : 0);
    effect.late_ticks += late;
    timed.has_acted = timed.has_acted || lost || in_row || twice || late > 0;
  }
  return effect;
}

}  // namespace giveway::sim
