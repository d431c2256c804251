#include "services/link/impairment/channel_model.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "services/types/check.h"

namespace giveway::link {
namespace {

// `since_start_s`: minus infinity before the start signal.
bool Holds(const ImpairmentRule& rule, double since_start_s) {
  return (!rule.from_s || since_start_s >= *rule.from_s) &&
         (!rule.to_s || since_start_s < *rule.to_s);
}

bool Fits(const ImpairmentRule& rule, const Sender& sender, VehicleId hearer) {
  if (rule.to_vehicle != kNoVehicle && rule.to_vehicle != hearer) return false;
  switch (rule.from) {
    case ImpairedSender::kAnyone:
      return true;
    case ImpairedSender::kVehicles:
      return sender.kind == Sender::Kind::kVehicle;
    case ImpairedSender::kWorld:
      return sender.kind == Sender::Kind::kWorld;
    case ImpairedSender::kOneVehicle:
      return sender.kind == Sender::Kind::kVehicle && sender.number == Number(rule.from_vehicle);
  }
  return false;
}

// Each hearer loses packets of its own.
Random DiceOf(std::uint32_t seed, VehicleId hearer, const Sender& sender) {
  const std::uint64_t of_hearer = Random(seed, Number(hearer)).Next();
  return Random(of_hearer, static_cast<std::uint64_t>(sender.kind) << 32U | sender.number);
}

// Of turning bad, so that in the long run `burst` of the packets meet a bad time.
double TurnsBad(const ImpairmentRule& rule) {
  return rule.burst / ((1 - rule.burst) * rule.burst_length);
}

void Refill(const ImpairmentRule& rule, SteadyTime now, double* tokens_bytes, SteadyTime* at) {
  const double fresh_bytes = Seconds(now - *at) * rule.rate_bytes_s;
  *tokens_bytes = std::min(rule.rate_burst_bytes, *tokens_bytes + fresh_bytes);
  *at = now;
}

}  // namespace

// Each uniform in [0, 1), in the order they are taken.
struct ChannelModel::Draws {
  explicit Draws(Random& dice)
      : loss(dice.Uniform(0, 1)),
        turn(dice.Uniform(0, 1)),
        burst(dice.Uniform(0, 1)),
        jitter(dice.Uniform(0, 1)),
        hold(dice.Uniform(0, 1)),
        copy(dice.Uniform(0, 1)),
        copy_jitter(dice.Uniform(0, 1)),
        corrupt(dice.Uniform(0, 1)),
        bit(dice.Uniform(0, 1)) {}

  Nanoseconds Delay(const ImpairmentRule& rule, double of_jitter) const {
    return FromSeconds(rule.delay_s + (2 * of_jitter - 1) * rule.jitter_s);
  }

  double loss, turn, burst, jitter, hold, copy, copy_jitter, corrupt, bit;
};

ChannelModel::ChannelModel(Impairment impairment)
    : impairment_(std::move(impairment)), started_(impairment_.started) {
  GIVEWAY_CHECK(impairment_.seed.has_value());
}

void ChannelModel::NameHearer(VehicleId hearer) {
  if (hearer == hearer_) return;
  hearer_ = hearer;
  for (auto& [sender, channel] : channels_) Begin(sender, channel.asked_at, &channel);
}

void ChannelModel::Start(SteadyTime now) {
  if (started_) return;
  started_ = now;
  for (auto& [sender, channel] : channels_) channel.rule_until = now;
}

const ImpairmentRule* ChannelModel::RuleFor(const Sender& sender, SteadyTime now) const {
  const auto& rules = impairment_.rules;
  const double since_s =
      started_ ? Seconds(now - *started_) : -std::numeric_limits<double>::infinity();
  const auto last = std::find_if(rules.rbegin(), rules.rend(), [&](const ImpairmentRule& rule) {
    return Fits(rule, sender, hearer_) && Holds(rule, since_s);
  });
  return last == rules.rend() ? nullptr : &*last;
}

// The first moment after `now` at which a rule starts or ends, as far as is known now.
SteadyTime ChannelModel::NextChange(SteadyTime now) const {
  SteadyTime next = SteadyTime::max();
  if (!started_) return next;
  for (const ImpairmentRule& rule : impairment_.rules) {
    for (const auto& moment_s : {rule.from_s, rule.to_s}) {
      if (!moment_s) continue;
      const SteadyTime moment = *started_ + FromSeconds(*moment_s);
      if (moment > now) next = std::min(next, moment);
    }
  }
  return next;
}

// Switches to another rule: its burst state starts good, its bucket full. The random stream
// continues.
void ChannelModel::Renew(const Sender& sender, SteadyTime now, Channel* channel) const {
  channel->rule_until = NextChange(now);
  const ImpairmentRule* rule = RuleFor(sender, now);
  if (rule == channel->rule) return;
  channel->rule = rule;
  channel->bad = false;
  channel->tokens_bytes = rule == nullptr ? 0 : rule->rate_burst_bytes;
  channel->tokens_at = now;
}

void ChannelModel::Begin(const Sender& sender, SteadyTime now, Channel* channel) const {
  channel->rule = RuleFor(sender, now);
  channel->rule_until = NextChange(now);
  channel->dice = DiceOf(*impairment_.seed, hearer_, sender);
  if (channel->rule == nullptr) return;
  channel->bad = channel->dice.Uniform(0, 1) < channel->rule->burst;
  channel->tokens_bytes = channel->rule->rate_burst_bytes;
  channel->tokens_at = now;
}

ChannelModel::Channel& ChannelModel::ChannelOf(const Sender& sender, SteadyTime now) {
  const auto [found, is_new] = channels_.try_emplace(sender);
  Channel& channel = found->second;
  channel.asked_at = now;
  if (is_new) {
    Begin(sender, now, &channel);
  } else if (now >= channel.rule_until) {
    Renew(sender, now, &channel);
  }
  return channel;
}

bool ChannelModel::IsBlackout(const ImpairmentRule& rule, SteadyTime now) const {
  if (!started_) return false;
  const double since_start_s = Seconds(now - *started_);
  return std::any_of(rule.blackouts.begin(), rule.blackouts.end(), [&](const Blackout& blackout) {
    return since_start_s >= blackout.from_s && since_start_s < blackout.to_s;
  });
}

// Counts the one cause.
bool ChannelModel::IsDropped(const Draws& draws, std::uint32_t bytes, SteadyTime now,
                             Channel* channel) const {
  const ImpairmentRule& rule = *channel->rule;
  ImpairmentCounters& counters = channel->counters;
  channel->bad = channel->bad ? draws.turn >= 1 / rule.burst_length : draws.turn < TurnsBad(rule);
  if (IsBlackout(rule, now)) return ++counters.dropped_blackout;
  if (rule.rate_bytes_s > 0) {
    ++counters.metered;
    Refill(rule, now, &channel->tokens_bytes, &channel->tokens_at);
    if (channel->tokens_bytes <= 0) return ++counters.dropped_rate;
    channel->tokens_bytes -= bytes;
  }
  if (draws.loss < rule.loss) return ++counters.dropped_loss;
  if (channel->bad && draws.burst < rule.burst_loss) return ++counters.dropped_burst;
  return false;
}

PacketFate ChannelModel::Decide(const Sender& sender, std::uint32_t bytes, SteadyTime now) {
  Channel& channel = ChannelOf(sender, now);
  ImpairmentCounters& counters = channel.counters;
  ++counters.packets;
  counters.bytes += bytes;
  PacketFate fate;
  // Drawn where no rule holds, too: the start of a rule must not change what happens to later
  // packets.
  const Draws draws(channel.dice);
  if (channel.rule != nullptr) {
    const ImpairmentRule& rule = *channel.rule;
    if (IsDropped(draws, bytes, now, &channel)) return {.dropped = true};
    fate.delay = draws.Delay(rule, draws.jitter);
    if (draws.hold < rule.reorder) {
      fate.delay += FromSeconds(rule.reorder_by_s);
      ++counters.held_back;
    }
    if (draws.copy < rule.duplicate) fate.copy_delay = draws.Delay(rule, draws.copy_jitter);
    if (draws.corrupt < rule.corrupt && bytes > 0) {
      fate.flipped_bit = static_cast<std::uint32_t>(draws.bit * 8 * bytes);
    }
  }
  ++counters.passed;
  counters.passed_bytes += bytes;
  counters.delayed += fate.delay > Nanoseconds{0} ? 1 : 0;
  counters.duplicated += fate.copy_delay ? 1 : 0;
  counters.corrupted += fate.flipped_bit ? 1 : 0;
  counters.reordered += now + fate.delay < channel.latest_due ? 1 : 0;
  channel.latest_due = std::max(channel.latest_due, now + fate.delay);
  return fate;
}

ImpairmentCounters ChannelModel::Counters() const {
  ImpairmentCounters sum;
  for (const auto& [sender, channel] : channels_) sum += channel.counters;
  return sum;
}

ImpairmentCounters ChannelModel::CountersOf(const Sender& sender) const {
  const auto found = channels_.find(sender);
  return found == channels_.end() ? ImpairmentCounters{} : found->second.counters;
}

}  // namespace giveway::link
