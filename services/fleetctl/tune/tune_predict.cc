#include "services/fleetctl/tune/tune_predict.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace giveway::fleetctl {
namespace {

constexpr int kMostLost = 200;           // in a row; rarer cases are lumped together
constexpr double kHostJitterMs = 0.5;    // of an idle machine, half the width
constexpr double kLoopbackMs = 0.5;      // from the sender's loop cycle to the reader
constexpr double kTimerEarlyMs = 0.5;    // mean: Fast DDS 2.9.1 cuts timers to whole milliseconds
constexpr double kDetectionSlackMs = 5;  // beyond three standard errors: the host's own pauses
constexpr int kDelaySteps = 64;

const ImpairmentRule* LastFor(const Impairment& impairment, ImpairedSender sender) {
  const ImpairmentRule* last = nullptr;
  for (const ImpairmentRule& rule : impairment.rules) {
    if (rule.from == ImpairedSender::kAnyone || rule.from == sender) last = &rule;
  }
  return last;
}

bool HasClosedForm(const ImpairmentRule& rule) {
  return rule.to_vehicle == kNoVehicle && rule.from != ImpairedSender::kOneVehicle &&
         rule.reorder == 0 && rule.corrupt == 0 && rule.rate_bytes_s == 0 &&
         rule.blackouts.empty() && !rule.from_s && !rule.to_s;
}

// The difference of two numbers drawn uniformly from [-width, width] has a triangular distribution.
double ChanceOfMore(double x, double width) {
  const double u = x / (2 * width);
  if (u >= 1) return 0;
  if (u <= -1) return 1;
  return u >= 0 ? 0.5 * (1 - u) * (1 - u) : 1 - 0.5 * (1 + u) * (1 + u);
}

class Model {
 public:
  Model(const BeaconQos& qos, const BeaconChannel& channel, const TuneFleet& fleet)
      : channel_(channel),
        tick_(fleet.tick_ms),
        limits_{Milliseconds(qos.requested), Milliseconds(qos.lease)},
        age_limit_(fleet.age_limit_ms) {}

  // Of one peer, per beacon.
  double AlarmsPerBeacon() const { return BySilences() + ByOwnLostScans(); }

  // From the last beacon sent, after which `lost` are lost, to the loop cycle that acts on it.
  double Detection() const {
    double sum = 0;
    double lost_before = 0;
    for (int lost = 1; lost <= kMostLost; ++lost) {
      lost_before += lost * SilenceProbability(channel_, lost);
    }
    for (int i = 0; i < kDelaySteps; ++i) {
      const double share = 2 * (i + 0.5) / kDelaySteps - 1;
      sum += DetectionAfter(channel_.delay_ms + share * channel_.jitter_ms + kLoopbackMs);
    }
    const double late = channel_.scan_loss * tick_ / 2;  // the acting cycle, if its scan is lost
    return sum / kDelaySteps + late - lost_before * tick_;
  }

  double MeanAge() const {
    double behind = std::ceil((channel_.delay_ms + kLoopbackMs) / tick_);
    for (int lost = 1; lost <= kMostLost; ++lost) {
      behind += lost * SilenceProbability(channel_, lost);
    }
    return behind * tick_;
  }

 private:
  // Deadline or lease, whichever is first.
  double Limit() const { return std::min(limits_[0], limits_[1]) - kTimerEarlyMs; }

  // Silences of exactly m lost beacons, over all m, that any mechanism reports.
  double BySilences() const {
    double alarms = 0;
    double longer = SilenceProbability(channel_, 0);
    for (int lost = 0; lost <= kMostLost; ++lost) {
      const double this_long = longer;
      longer = SilenceProbability(channel_, lost + 1);
      alarms += (this_long - longer) * AlarmGiven(lost);
    }
    return alarms + longer;
  }

  // A vehicle decides on beacons of ticks before its own: while its own scans are lost no newer one
  // counts, and age decides. Its loop then runs after 1.5, 3, 4, 5 ... ticks, the n-th time with n
  // scans lost; `lost` beacons before those make them older by as many ticks.
  double ByOwnLostScans() const {
    const double in_bursts = channel_.scan_burst * channel_.scan_burst_loss;
    const BeaconChannel own{.loss = 1 - (1 - channel_.scan_loss) / (1 - in_bursts),
                            .burst = channel_.scan_burst,
                            .burst_length = channel_.scan_burst_length,
                            .burst_loss = channel_.scan_burst_loss};
    double alarms = 0;
    for (int lost = 0; lost * tick_ < age_limit_; ++lost) {
      double unseen = 1;  // that no earlier cycle has noticed
      for (int scans = 1; scans <= kMostLost; ++scans) {
        const double reached = SilenceProbability(own, scans);
        const double turn = scans == 1 ? 1.5 : scans + 1;
        const double noticed = ChanceOfMore(age_limit_ - (turn + lost) * tick_, kHostJitterMs);
        alarms += SilenceProbability(channel_, lost) * reached * unseen * noticed;
        unseen *= 1 - noticed;
      }
    }
    return alarms;
  }

  // Probability that a silence exceeds `limit`: either end of it may be half a tick late.
  double LongerThan(double limit, int lost) const {
    const double width = channel_.jitter_ms + kHostJitterMs;
    const double missing = limit - (lost + 1) * tick_;
    const double q = channel_.scan_loss;
    return (q * q + (1 - q) * (1 - q)) * ChanceOfMore(missing, width) +
           q * (1 - q) * ChanceOfMore(missing - tick_ / 2, width) +
           q * (1 - q) * ChanceOfMore(missing + tick_ / 2, width);
  }

  double AlarmGiven(int lost) const {
    const double by_event = LongerThan(Limit(), lost);
    return std::max(by_event, ChanceOfMore(age_limit_ - lost * tick_, kHostJitterMs));
  }

  // The last beacon arrived `delay` ms after it was sent.
  double DetectionAfter(double delay) const {
    const double event_ms = delay + Limit();
    const double heard = std::ceil(delay / tick_) * tick_;
    // If the limit is a whole number of ticks, the cycle exactly on it may see it exceeded or not.
    const double ticks = age_limit_ / tick_;
    const double first = heard + (std::floor(ticks) + 1) * tick_;
    const bool whole = std::abs(ticks - std::round(ticks)) < 1e-9;
    const double early = whole ? heard + std::round(ticks) * tick_ : first;
    double sum = 0;
    for (const double jitter : {-2 * kHostJitterMs, 2 * kHostJitterMs}) {
      const double by_event = std::ceil((event_ms + jitter) / tick_) * tick_;
      sum += std::min(by_event, early) + std::min(by_event, first);
    }
    return sum / 4;
  }

  BeaconChannel channel_;
  double tick_;
  std::array<double, 2> limits_;  // deadline, lease
  double age_limit_;
};

}  // namespace

std::optional<BeaconChannel> ChannelOf(const Impairment& impairment) {
  if (!std::ranges::all_of(impairment.rules, HasClosedForm)) return std::nullopt;
  BeaconChannel channel;
  if (const ImpairmentRule* rule = LastFor(impairment, ImpairedSender::kVehicles)) {
    channel = {.loss = rule->loss,
               .burst = rule->burst,
               .burst_length = rule->burst_length,
               .burst_loss = rule->burst_loss,
               .delay_ms = rule->delay_s * 1000,
               .jitter_ms = rule->jitter_s * 1000};
  }
  if (const ImpairmentRule* rule = LastFor(impairment, ImpairedSender::kWorld)) {
    channel.scan_loss = 1 - (1 - rule->loss) * (1 - rule->burst * rule->burst_loss);
    channel.scan_burst = rule->burst;
    channel.scan_burst_length = rule->burst_length;
    channel.scan_burst_loss = rule->burst_loss;
  }
  return channel;
}

// Loss in a channel of two states (Gilbert 1960, Elliott 1963): the state moves with each packet,
// the packet is lost with the state's probability. With one state it is (1 - p) p^lost.
double SilenceProbability(const BeaconChannel& channel, int lost) {
  const double to_good = 1 / channel.burst_length;
  const double to_bad = channel.burst / ((1 - channel.burst) * channel.burst_length);
  const double lost_good = channel.loss;
  const double lost_bad = 1 - (1 - channel.loss) * (1 - channel.burst_loss);
  double good = (1 - channel.burst) * (1 - lost_good);
  double bad = channel.burst * (1 - lost_bad);
  for (int i = 0; i < lost; ++i) {
    const double next_good = good * (1 - to_bad) + bad * to_good;
    const double next_bad = good * to_bad + bad * (1 - to_good);
    good = next_good * lost_good;
    bad = next_bad * lost_bad;
  }
  return good + bad;
}

std::optional<Prediction> Predict(const BeaconQos& qos, const BeaconChannel& channel,
                                  const TuneFleet& fleet) {
  if (qos.reliable || fleet.vehicles < 2) return std::nullopt;
  const Model model(qos, channel, fleet);
  const double beacons_per_hour = 3'600'000 / fleet.tick_ms;
  return Prediction{
      .alarms_per_hour = model.AlarmsPerBeacon() * beacons_per_hour * (fleet.vehicles - 1),
      .detection_ms = model.Detection(),
      .age_mean_ms = model.MeanAge()};
}

std::string Disagreement(const TuneFigures& measured, const Prediction& predicted) {
  std::string words;
  const auto add = [&words](const char* what) {
    words += (words.empty() ? "" : ", ") + std::string(what);
  };
  if (predicted.alarms_per_hour > measured.alarms_high) add("fewer alarms than predicted");
  if (predicted.alarms_per_hour < measured.alarms_low) add("more alarms than predicted");
  const double off = measured.detection_ms - predicted.detection_ms;
  if (measured.detections > 1 &&
      std::abs(off) > 3 * measured.detection_error_ms + kDetectionSlackMs) {
    add(off > 0 ? "noticed later than predicted" : "noticed earlier than predicted");
  }
  return words;
}

}  // namespace giveway::fleetctl
