#include "services/fleetctl/tune/tune_evidence.h"

#include <algorithm>
#include <array>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

namespace giveway::fleetctl {
namespace {

constexpr double kSecondsAnHour = 3600;

double Rate(double count, double hours) { return hours > 0 ? count / hours : 0; }

bool IsSound(const TrialEvidence& trial) { return trial.trouble.empty(); }

double VehicleHours(const TrialEvidence& trial) {
  return trial.vehicles * trial.alive_s / kSecondsAnHour;
}

// The standard error of a mean of readings of which those of one trial are correlated: its peers
// lose the same target after the same last beacon. By Liang and Zeger, Biometrika 73 (1986), or
// that of independent readings if it is larger: few trials may agree by chance.
double ErrorOfMean(const std::vector<TrialEvidence>& trials, double mean, double n) {
  double apart = 0;
  double together = 0;
  double sound = 0;
  for (const TrialEvidence& trial : trials) {
    if (!IsSound(trial) || trial.detections.empty()) continue;
    double off = 0;
    for (const DetectionReading& reading : trial.detections) {
      const double residual = reading.from_last_beacon_ms - mean;
      apart += residual * residual;
      off += residual;
    }
    together += off * off;
    ++sound;
  }
  const double alone = n > 1 ? apart / (n * (n - 1)) : 0;
  const double clustered = sound > 1 ? together / (n * n) * sound / (sound - 1) : 0;
  return std::sqrt(std::max(alone, clustered));
}

// Mean and largest of the detections, and the standard error of the mean.
void FoldDetections(const std::vector<TrialEvidence>& trials, TuneFigures* figures) {
  double sum = 0;
  double from_kill = 0;
  for (const TrialEvidence& trial : trials) {
    if (!IsSound(trial)) continue;
    for (const DetectionReading& reading : trial.detections) {
      ++figures->detections;
      figures->detected_by.Add(reading.cause);
      sum += reading.from_last_beacon_ms;
      from_kill += reading.from_kill_ms;
      figures->detection_max_ms = std::max(figures->detection_max_ms, reading.from_last_beacon_ms);
    }
  }
  if (figures->detections == 0) return;
  const double n = figures->detections;
  figures->detection_ms = sum / n;
  figures->detection_from_kill_ms = from_kill / n;
  figures->detection_error_ms = ErrorOfMean(trials, figures->detection_ms, n);
}

// Figures to which every second of a trial contributes alike.
void FoldShares(const std::vector<TrialEvidence>& trials, TuneFigures* figures) {
  double seconds = 0;
  double bytes = 0;
  double bytes_seconds = 0;
  for (const TrialEvidence& trial : trials) {
    if (!IsSound(trial)) continue;
    seconds += trial.alive_s;
    figures->age_mean_ms += trial.age_mean_ms * trial.alive_s;
    figures->cpu_share += trial.cpu_share * trial.alive_s;
    if (!trial.heard_bytes_s) continue;
    bytes += *trial.heard_bytes_s * trial.alive_s;
    bytes_seconds += trial.alive_s;
  }
  if (seconds > 0) {
    figures->age_mean_ms /= seconds;
    figures->cpu_share /= seconds;
  }
  if (bytes_seconds > 0) figures->heard_bytes_s = bytes / bytes_seconds;
}

}  // namespace

std::string_view Name(AlarmCause cause) {
  constexpr std::array<std::string_view, 3> kNames = {"deadline", "liveliness", "beacon_age"};
  return kNames.at(static_cast<std::size_t>(cause));
}

void AlarmCounts::Add(AlarmCause cause) {
  if (cause == AlarmCause::kDeadline) ++deadline;
  if (cause == AlarmCause::kLiveliness) ++liveliness;
  if (cause == AlarmCause::kBeaconAge) ++beacon_age;
}

AlarmCounts& AlarmCounts::operator+=(const AlarmCounts& more) {
  deadline += more.deadline;
  liveliness += more.liveliness;
  beacon_age += more.beacon_age;
  return *this;
}

std::optional<TuneFigures> FiguresOf(const std::vector<TrialEvidence>& trials, double dispersion) {
  TuneFigures figures;
  std::uint32_t reported = 0;
  for (const TrialEvidence& trial : trials) {
    if (!IsSound(trial)) continue;
    ++figures.trials;
    figures.vehicle_hours += VehicleHours(trial);
    figures.alarms += trial.alarms;
    reported += trial.reported_deadline + trial.reported_liveliness;
    figures.undetected += trial.undetected;
    figures.age_p99_ms = std::max(figures.age_p99_ms, trial.age_p99_ms);
    figures.longest_pause_ms = std::max(figures.longest_pause_ms, trial.longest_pause_ms);
  }
  if (figures.trials == 0) return std::nullopt;
  figures.dispersion = dispersion;
  const CountInterval interval =
      PoissonInterval(figures.alarms.Total(), kZ99 * std::sqrt(dispersion));
  figures.alarms_per_hour = Rate(figures.alarms.Total(), figures.vehicle_hours);
  figures.alarms_low = Rate(interval.low, figures.vehicle_hours);
  figures.alarms_high = Rate(interval.high, figures.vehicle_hours);
  figures.reported_per_hour = Rate(reported, figures.vehicle_hours);
  FoldDetections(trials, &figures);
  FoldShares(trials, &figures);
  return figures;
}

double Dispersion(const std::vector<std::vector<TrialEvidence>>& candidates) {
  double chi_squared = 0;
  double degrees = 0;
  for (const std::vector<TrialEvidence>& trials : candidates) {
    const auto figures = FiguresOf(trials);
    if (!figures || figures->trials < 2 || figures->alarms.Total() == 0) continue;
    for (const TrialEvidence& trial : trials) {
      if (!IsSound(trial)) continue;
      const double expected = figures->alarms_per_hour * VehicleHours(trial);
      const double off = trial.alarms.Total() - expected;
      chi_squared += off * off / expected;
    }
    degrees += figures->trials - 1;
  }
  return degrees > 0 ? std::max(1.0, chi_squared / degrees) : 1;
}

// Exact (Garwood 1936).
CountInterval PoissonInterval(std::uint32_t count, double z) {
  // Beyond 37 standard deviations nothing is left that a double holds.
  const double tail = cdf(complement(boost::math::normal(), std::min(z, 37.0)));
  return {count == 0 ? 0 : boost::math::gamma_p_inv(static_cast<double>(count), tail),
          boost::math::gamma_q_inv(count + 1.0, tail)};
}

}  // namespace giveway::fleetctl
