#include "services/link/packet_filter/sequence_budget.h"

#include <algorithm>

namespace giveway::link {
namespace {

// While two senders may be at it.
constexpr double kDisputedShare = 1.25;
constexpr double kDisputedRate_hz = 2;

}  // namespace

SequenceBudget::SequenceBudget(std::int64_t number, SteadyTime now, const Limits& limits)
    : highest_(number),
      started_(now),
      advanced_(now),
      heard_(now),
      budget_(limits.are_shared ? limits.least : kYoungSlack),
      window_number_(number),
      window_began_(now) {}

bool SequenceBudget::Takes(std::int64_t number, SteadyTime now, const Limits& limits) {
  Learn(now);
  const double most = SlackAt(now, limits);
  if (number <= highest_) {
    if (!limits.sends_again) TakeBehind(number, now, most);
    return true;
  }
  const double step = static_cast<double>(number - highest_);
  const double budget = std::min(budget_, most) + Added(heard_, now);
  const bool is_free = step <= 1 && (limits.may_grow || IsYoung(now));
  if (!is_free && step > budget) return Confirms(number, now, limits);
  budget_ = std::clamp(is_free ? budget : budget - step, 0.0, most);
  highest_ = number;
  advanced_ = heard_ = now;
  candidate_ = 0;
  return true;
}

bool SequenceBudget::MayReach(std::int64_t number, SteadyTime now, const Limits& limits) const {
  return static_cast<double>(number - highest_) <= SlackAt(now, limits) + Added(advanced_, now);
}

double SequenceBudget::SlackAt(SteadyTime now, const Limits& limits) const {
  const double most = limits.SlackAt(pace_hz_);
  return IsYoung(now) ? std::max(most, kYoungSlack) : most;
}

double SequenceBudget::RateAt(SteadyTime now) const {
  if (now < disputed_until_) return kDisputedShare * pace_hz_ + kDisputedRate_hz;
  return std::clamp(2 * pace_hz_, kLeastRate_hz, kHighestRate_hz);
}

// By the time in which nothing was heard.
double SequenceBudget::Added(SteadyTime since, SteadyTime now) const {
  return RateAt(now) * Seconds(std::max(now - since, Nanoseconds{0}));
}

// Once a window, from what passed in it. The faster of two windows, so that the one in which a
// silence fell does not count as slow.
void SequenceBudget::Learn(SteadyTime now) {
  if (now - window_began_ < kYoung) return;
  const double time_s = Seconds(std::max(advanced_ - window_began_, kYoung));
  const double window_hz = static_cast<double>(highest_ - window_number_) / time_s;
  window_number_ = highest_;
  window_began_ = now;
  if (now < disputed_until_) return;
  pace_hz_ = std::max(window_hz, last_window_hz_);
  last_window_hz_ = window_hz;
}

void SequenceBudget::TakeBehind(std::int64_t number, SteadyTime now, double slack) {
  budget_ = std::min(budget_ + Added(heard_, now), slack);
  heard_ = now;
  if (number == highest_) return;  // a packet that came twice
  candidate_ = 0;
  const bool far = static_cast<double>(highest_ - number) > slack;
  if (far && pace_hz_ > 0) disputed_until_ = now + kDisputeTime;
}

// Whether that is how its numbers go now: it has kept to it.
bool SequenceBudget::Confirms(std::int64_t number, SteadyTime now, const Limits& limits) {
  const double rate_hz = limits.are_shared ? kHighestRate_hz : kLeastRate_hz;
  const double since_s = Seconds(now - candidate_heard_);
  const bool goes_on = candidate_ != 0 && number >= candidate_ &&
                       static_cast<double>(number - candidate_) <= kYoungSlack + rate_hz * since_s;
  if (!goes_on) {
    first_candidate_ = number;
    candidate_since_ = now;
    confirmations_ = 0;
  }
  candidate_ = number;
  candidate_heard_ = now;
  ++confirmations_;
  if (confirmations_ < kConfirmations || now - candidate_since_ < kConfirmTime) return false;
  const double pace_hz =
      static_cast<double>(number - first_candidate_) / Seconds(now - candidate_since_);
  *this = SequenceBudget(number, now, limits);
  if (limits.are_shared) pace_hz_ = last_window_hz_ = pace_hz;
  return true;
}

}  // namespace giveway::link
