#include "sim_world/virtual/radio.h"

#include <algorithm>
#include <array>

#include "services/types/check.h"
#include "services/types/time.h"
#include "services/vehicle/estimation/beacon_check.h"

namespace giveway::sim {
namespace {

// Beacons still arrive from beyond the listening radius, so that a brain learns that a peer left
// it. One stated from well outside shows that; more would only be counted.
constexpr double kFringe_m = 1.5;
constexpr double kWellOutside_m = 0.5;
constexpr std::uint32_t kHeldBackTicks = 2;

constexpr std::uint64_t kOfBurst = 0x9e3779b97f4a7c15ULL;

// The finaliser of SplitMix64: every bit of the result depends on every bit of `x`.
std::uint64_t Mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

// One draw is cut into three numbers of 21 bits in [0, 1).
double Part(std::uint64_t draw, int which) {
  constexpr std::uint64_t kMask = (1ULL << 21) - 1;
  return static_cast<double>((draw >> (21 * which)) & kMask) * 0x1p-21;
}

double UnitInterval(std::uint64_t draw) { return static_cast<double>(draw >> 11) * 0x1p-53; }

double Power(double base, std::uint32_t exponent) {
  double result = 1;
  for (; exponent > 0; exponent >>= 1U, base *= base) {
    if ((exponent & 1U) != 0) result *= base;
  }
  return result;
}

std::vector<VehicleId> IdsOf(const Scenario& scenario) {
  std::vector<VehicleId> ids;
  for (const VehicleOptions& options : scenario.vehicles) ids.push_back(options.id);
  return ids;
}

std::uint32_t TicksUnderWay(Nanoseconds time, Nanoseconds period) {
  return std::clamp(TicksCovering(time, period), 1U, kLongestTicks);
}

}  // namespace

Radio::Radio(const Scenario& scenario, const RadioSettings& settings, std::uint64_t seed)
    : settings_(settings),
      seed_(Mix(seed + 1)),
      period_(scenario.tick_period),
      count_(scenario.vehicles.size()),
      shortest_ticks_(TicksUnderWay(settings.delay, period_)),
      longest_ticks_(TicksUnderWay(settings.delay + settings.jitter, period_) +
                     (settings.reorder > 0 ? kHeldBackTicks : 0) +
                     (settings.duplicate > 0 ? 1 : 0)),
      rules_(settings.rules, IdsOf(scenario), seed_, period_),
      most_ticks_(longest_ticks_ + rules_.MostLate()),
      kept_ticks_(most_ticks_ + 1),
      varies_(settings.jitter.count() > 0 || settings.reorder > 0 || settings.duplicate > 0),
      draws_(varies_ || settings.loss > 0 || settings.burst.enter > 0),
      deadline_(std::max(kDeadlineRequested, kDeadlinePeriods * period_)),
      lease_(std::max(kLivelinessLease, kLeasePeriods * period_)),
      deadline_ticks_(TicksCovering(deadline_, period_)),
      lease_ticks_(TicksCovering(lease_, period_)),
      ids_(IdsOf(scenario)),
      history_(count_ * kept_ticks_),
      pairs_(count_ * count_),
      expected_(count_ * count_),
      expected_count_(count_),
      places_(count_),
      positions_world_(count_),
      blacked_out_(count_) {
  for (const VehicleOptions& options : scenario.vehicles) {
    reach_m_.push_back(settings.reach_m.value_or(options.emission_radius_m + kFringe_m));
    listen_m_.push_back(settings.reach_m ? reach_m_.back() : options.emission_radius_m);
    widest_reach_m_ = std::max(widest_reach_m_, reach_m_.back());
  }
}

void Radio::Transmit(std::size_t sender, Tick tick, const Beacon& beacon) {
  SentBeacon& sent = history_[sender * kept_ticks_ + Number(tick) % kept_ticks_];
  sent.tick = tick;
  sent.beacon = {.beacon = beacon,
                 .received = SteadyTime{0},
                 .crc_valid = true,
                 .name_valid = true,
                 .writer = beacon.boot_epoch,
                 .in_range = IsInRange(beacon)};
}

void Radio::BeginTick(Tick now, double time_s, std::span<const RadioPlace> places) {
  GIVEWAY_CHECK(places.size() == count_);
  now_ = now;
  heard_at_ = Number(now) * period_;
  for (std::size_t i = 0; i < count_; ++i) {
    places_[i] = places[i];
    positions_world_[i] = places[i].position_world;
  }
  grid_.Rebuild(positions_world_, widest_reach_m_);
  if (!settings_.blackouts.empty()) MarkBlackouts(time_s);
  rules_.BeginTick(time_s);
}

void Radio::MarkBlackouts(double time_s) {
  std::ranges::fill(blacked_out_, std::uint8_t{0});
  for (const Blackout& blackout : settings_.blackouts) {
    if (time_s < blackout.from_s || time_s >= blackout.to_s) continue;
    for (std::size_t i = 0; i < count_; ++i) {
      if (blackout.vehicle == kNoVehicle || blackout.vehicle == ids_[i]) blacked_out_[i] = 1;
    }
  }
}

double Radio::SquaredDistance(std::size_t receiver, std::size_t sender) const {
  return SquaredNorm(positions_world_[sender] - positions_world_[receiver]);
}

bool Radio::IsInReach(std::size_t receiver, std::size_t sender) const {
  return SquaredDistance(receiver, sender) <= reach_m_[receiver] * reach_m_[receiver];
}

bool Radio::KnowsItIsFar(std::size_t receiver, std::size_t sender, Pair* pair) const {
  if (!pair->stated_far) return false;
  const double listen_m = listen_m_[receiver];
  if (SquaredDistance(receiver, sender) <= listen_m * listen_m) pair->stated_far = false;
  return pair->stated_far;
}

std::uint64_t Radio::Draw(std::size_t receiver, std::size_t sender, std::uint32_t tick,
                          std::uint64_t salt) const {
  const std::uint64_t pair = receiver * count_ + sender;
  return Mix(Mix(seed_ ^ salt ^ (pair << 32U)) + tick * 0x9e3779b97f4a7c15ULL);
}

void Radio::Hear(std::size_t receiver, std::vector<ReceivedBeacon>* heard) {
  if (blacked_out_[receiver] != 0) return;
  grid_.Near(positions_world_[receiver], reach_m_[receiver],
             [&](std::uint32_t begin, std::uint32_t end) {
               for (std::uint32_t at = begin; at < end; ++at) {
                 const std::size_t sender = grid_.Order()[at];
                 if ((sender != receiver || settings_.loops_back) && IsInReach(receiver, sender)) {
                   HearSender(receiver, sender, heard);
                 }
               }
             });
}

// The chain is carried over the ticks not asked for in closed form: its eigenvalue is
// 1 - enter - leave, and its stationary share of bad links enter / (enter + leave).
bool Radio::IsLinkBad(std::size_t receiver, std::size_t sender, Pair* pair) const {
  const BurstLoss& burst = settings_.burst;
  if (burst.enter <= 0) return false;
  const std::uint32_t now = Number(now_);
  const double share = burst.enter / (burst.enter + burst.leave);
  double bad = share;  // the first time
  if (pair->burst_tick != 0) {
    const double kept = Power(1 - burst.enter - burst.leave, now - pair->burst_tick);
    bad = pair->bad ? share + (1 - share) * kept : share - share * kept;
  }
  if (pair->burst_tick != now)
    pair->bad = UnitInterval(Draw(receiver, sender, now, kOfBurst)) < bad;
  pair->burst_tick = now;
  return pair->bad;
}

bool Radio::IsLost(std::size_t receiver, std::size_t sender, std::uint64_t draw, Pair* pair) const {
  const double loss = IsLinkBad(receiver, sender, pair) ? settings_.burst.loss : settings_.loss;
  return Part(draw, 0) < loss;
}

// When a beacon is received, in ticks after it was sent, and whether again a tick later.
Radio::Fate Radio::FateOf(std::uint64_t draw) const {
  if (!varies_) return {shortest_ticks_, false};
  const Nanoseconds jitter{
      static_cast<std::int64_t>(Part(draw, 1) * static_cast<double>(settings_.jitter.count()))};
  // The rest of the draw decides on the rarer fates: they exclude each other.
  const double fate = Part(draw, 2);
  const bool held_back = fate < settings_.reorder;
  return {TicksUnderWay(settings_.delay + jitter, period_) + (held_back ? kHeldBackTicks : 0),
          !held_back && fate < settings_.reorder + settings_.duplicate};
}

// Determines its fate by the rules that were active when it was sent; false: one of them loses it.
bool Radio::SurvivesRules(std::size_t receiver, std::size_t sender, std::uint32_t ticks,
                          Fate* fate) {
  const RadioRules::Effect effect = rules_.Of(receiver, sender, ticks, Number(now_) - ticks);
  fate->twice = fate->twice || effect.twice;
  fate->due = std::min(fate->due + effect.late_ticks, most_ticks_ - (fate->twice ? 1 : 0));
  return !effect.lost;
}

bool Radio::HasJustSent(std::size_t sender) const {
  if (shortest_ticks_ >= Number(now_)) return false;
  const std::uint32_t sent_tick = Number(now_) - shortest_ticks_;
  return history_[sender * kept_ticks_ + sent_tick % kept_ticks_].tick == Tick{sent_tick};
}

void Radio::HearSender(std::size_t receiver, std::size_t sender,
                       std::vector<ReceivedBeacon>* heard) {
  if (blacked_out_[sender] != 0) return;
  const bool ruled = rules_.Any();
  if (ruled && rules_.IsCut(receiver, sender, HasJustSent(sender))) return;
  Pair& pair = pairs_[receiver * count_ + sender];
  if (KnowsItIsFar(receiver, sender, &pair)) return;
  const std::size_t first = heard->size();
  // Longest in transit first: it was sent first.
  for (std::uint32_t ticks = ruled ? most_ticks_ : longest_ticks_; ticks >= shortest_ticks_;
       --ticks) {
    if (ticks >= Number(now_)) continue;
    const std::uint32_t sent_tick = Number(now_) - ticks;
    const SentBeacon& sent = history_[sender * kept_ticks_ + sent_tick % kept_ticks_];
    if (sent.tick != Tick{sent_tick}) continue;
    const std::uint64_t draw = draws_ ? Draw(receiver, sender, sent_tick, 0) : 0;
    Fate fate = FateOf(draw);
    if (ruled && !SurvivesRules(receiver, sender, ticks, &fate)) continue;
    if (ticks != fate.due && !(fate.twice && ticks == fate.due + 1)) continue;
    if (draws_ && IsLost(receiver, sender, draw, &pair)) continue;
    heard->push_back(sent.beacon);
    heard->back().received = heard_at_;
  }
  if (heard->size() == first) return;
  MarkHeard(receiver, sender, &pair);
  const Vec2 stated = heard->back().beacon.world_from_body.position_world;
  const double far_m = listen_m_[receiver] + kWellOutside_m;
  pair.stated_far = SquaredNorm(stated - positions_world_[receiver]) > far_m * far_m;
}

void Radio::MarkHeard(std::size_t receiver, std::size_t sender, Pair* pair) {
  pair->heard_tick = Number(now_);
  pair->deadline_missed = false;
  if (pair->listed) return;
  pair->listed = true;
  expected_[receiver * count_ + expected_count_[receiver]++] = static_cast<std::uint32_t>(sender);
}

// Each edge is reported once. A peer that left the radius is not missed: the middleware still
// receives it. One that is lost permanently is no longer expected.
void Radio::Notice(std::size_t receiver, std::vector<QosEvent>* events) {
  std::uint32_t* const expected = expected_.data() + receiver * count_;
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < expected_count_[receiver]; ++i) {
    const std::uint32_t sender = expected[i];
    Pair& pair = pairs_[receiver * count_ + sender];
    pair.listed = !HasLeft(receiver, sender, pair);
    if (pair.listed && pair.heard_tick != Number(now_)) NoticeSilence(sender, &pair, events);
    if (pair.listed) expected[kept++] = sender;
  }
  expected_count_[receiver] = kept;
}

bool Radio::HasLeft(std::size_t receiver, std::size_t sender, const Pair& pair) const {
  if (pair.stated_far) return true;
  if (pair.heard_tick == Number(now_) || settings_.reach_m) return false;
  return places_[sender].on_air && !IsInReach(receiver, sender);
}

void Radio::NoticeSilence(std::size_t sender, Pair* pair, std::vector<QosEvent>* events) const {
  const std::uint32_t silent = Number(now_) - pair->heard_tick;
  const auto tell = [&](QosEventKind kind, Nanoseconds after) {
    events->push_back(
        {.kind = kind, .vehicle = ids_[sender], .at = pair->heard_tick * period_ + after});
  };
  if (silent >= deadline_ticks_ && !pair->deadline_missed) {
    pair->deadline_missed = true;
    tell(QosEventKind::kDeadlineMissed, deadline_);
  }
  if (silent < lease_ticks_) return;
  tell(QosEventKind::kLivelinessLost, lease_);
  pair->listed = false;
}

}  // namespace giveway::sim
