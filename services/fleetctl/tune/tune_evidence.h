// The results of trials of a set of QoS profiles: the evidence of one trial, and the figures of all
// trials of a candidate. Pure; tune_reading.h obtains the evidence.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace giveway::fleetctl {

// The mechanism by which a vehicle lost trust in a peer.
enum class AlarmCause : std::uint8_t { kDeadline, kLiveliness, kBeaconAge };
std::string_view Name(AlarmCause cause);

// How often a vehicle lost trust in a peer, by the mechanism that reported it first.
struct AlarmCounts {
  std::uint32_t deadline = 0;
  std::uint32_t liveliness = 0;
  std::uint32_t beacon_age = 0;

  std::uint32_t Total() const { return deadline + liveliness + beacon_age; }
  void Add(AlarmCause cause);
  AlarmCounts& operator+=(const AlarmCounts& more);
};

// One peer that noticed one killed vehicle.
struct DetectionReading {
  double from_kill_ms = 0;
  double from_last_beacon_ms = 0;  // since the target's last one
  AlarmCause cause = AlarmCause::kDeadline;
};

// One fleet that ran for a while with all alive, and then lost vehicles one after another.
struct TrialEvidence {
  std::string candidate;
  bool verification = false;  // of the fresh runs at the end
  std::uint32_t trial = 0;    // 0, 1, 2 ... of this candidate
  std::uint32_t seed = 0;
  std::string trouble;  // why there are no figures; empty if there are
  std::uint32_t vehicles = 0;
  double alive_s = 0;  // how long all were observed while all were alive
  AlarmCounts alarms;  // in that time: all of them false
  std::uint32_t reported_deadline =
      0;  // events counted by the vehicles in that time (fleet/status)
  std::uint32_t reported_liveliness = 0;
  double age_mean_ms = 0;  // of the newest beacon of a peer at a decision, by ticks
  double age_p99_ms = 0;
  std::optional<double> heard_bytes_s;  // per vehicle, all packets of the others and the world
  double cpu_share = 0;                 // of one core, per vehicle
  double longest_pause_ms = 0;          // between two cycles of any vehicle's loop
  std::vector<DetectionReading> detections;
  std::uint32_t undetected = 0;  // peers that still trusted a killed vehicle
};

// The figures of one candidate. Rates are per vehicle-hour, over all of a vehicle's peers.
struct TuneFigures {
  std::uint32_t trials = 0;
  double vehicle_hours = 0;
  AlarmCounts alarms;
  double alarms_per_hour = 0;
  double dispersion = 1;  // see Dispersion
  double alarms_low = 0;  // 99 % interval of the rate
  double alarms_high = 0;
  double reported_per_hour = 0;  // deadline and liveliness events
  std::uint32_t detections = 0;
  std::uint32_t undetected = 0;
  double detection_ms = 0;  // mean, from the target's last beacon
  double detection_error_ms =
      0;  // standard error of the mean; the readings of a trial are correlated
  double detection_max_ms = 0;
  double detection_from_kill_ms = 0;  // mean
  AlarmCounts detected_by;
  double age_mean_ms = 0;
  double age_p99_ms = 0;  // the largest of the trials'
  std::optional<double> heard_bytes_s;
  double cpu_share = 0;
  double longest_pause_ms = 0;
};

// Trials with trouble are left out; nullopt if there is no other.
std::optional<TuneFigures> FiguresOf(const std::vector<TrialEvidence>& trials,
                                     double dispersion = 1);

// The overdispersion of a trial's alarm count: the ratio of its variance to that of independent
// alarms, because a vehicle that loses a scan of its own doubts several peers at once. Estimated
// over the trials of all candidates together, because each candidate has few; at least 1. Pearson's
// chi-squared over its degrees of freedom (McCullagh and Nelder, Generalized Linear Models, 1989,
// 6.2.3).
double Dispersion(const std::vector<std::vector<TrialEvidence>>& candidates);

// The interval that covers the mean of a Poisson count with the two-sided confidence of `z`
// standard deviations of a normal distribution.
struct CountInterval {
  double low = 0;
  double high = 0;
};
CountInterval PoissonInterval(std::uint32_t count, double z);
inline constexpr double kZ99 = 2.5758;

}  // namespace giveway::fleetctl
