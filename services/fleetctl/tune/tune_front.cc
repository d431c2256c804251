#include "services/fleetctl/tune/tune_front.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace giveway::fleetctl {
namespace {

// A peer that missed a dead vehicle counts as never noticing it.
double Detection(const TuneFigures& figures) {
  return figures.detections == 0 || figures.undetected > 0 ? 1e12 : figures.detection_ms;
}

// In steps of what can be distinguished, so that chance alone puts none before another.
long DetectionStep(const TuneFigures& figures) {
  return std::lround(Detection(figures) / kSameDetectionMs);
}

bool Beats(const TuneFigures& one, const TuneFigures& other) {
  const auto key = [](const TuneFigures& f) {
    return std::pair(f.alarms_per_hour, DetectionStep(f));
  };
  const auto [alarms, detection] = key(one);
  const auto [other_alarms, other_detection] = key(other);
  return alarms <= other_alarms && detection <= other_detection && key(one) != key(other);
}

auto TieBreak(const TuneFigures& figures) {
  return std::tuple(figures.alarms_per_hour, figures.heard_bytes_s.value_or(0), figures.cpu_share);
}

// Those of `places` that no other of them dominates.
std::vector<std::size_t> FrontOf(const std::vector<TuneFigures>& figures,
                                 const std::vector<std::size_t>& places) {
  std::vector<std::size_t> front;
  for (const std::size_t place : places) {
    const bool beaten = std::ranges::any_of(
        places, [&](std::size_t other) { return Beats(figures[other], figures[place]); });
    if (!beaten) front.push_back(place);
  }
  return front;
}

std::vector<std::size_t> AllPlaces(const std::vector<TuneFigures>& figures) {
  std::vector<std::size_t> places(figures.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  return places;
}

}  // namespace

std::vector<std::size_t> ParetoFront(const std::vector<TuneFigures>& figures) {
  std::vector<std::size_t> front = FrontOf(figures, AllPlaces(figures));
  std::ranges::stable_sort(front, {}, [&](std::size_t place) {
    return std::tuple_cat(std::tuple(DetectionStep(figures[place])), TieBreak(figures[place]));
  });
  return front;
}

std::vector<std::size_t> Ranking(const std::vector<TuneFigures>& figures) {
  std::vector<std::size_t> left = AllPlaces(figures);
  std::vector<std::size_t> ranking;
  while (!left.empty()) {
    std::vector<std::size_t> front = FrontOf(figures, left);
    std::ranges::stable_sort(front, {},
                             [&](std::size_t place) { return TieBreak(figures[place]); });
    for (const std::size_t place : front) std::erase(left, place);
    ranking.insert(ranking.end(), front.begin(), front.end());
  }
  return ranking;
}

bool HasFewerAlarms(const TuneFigures& one, const TuneFigures& than) {
  if (one.vehicle_hours <= 0 || than.vehicle_hours <= 0) return false;
  // The error of a zero count is that of a count of one.
  const auto variance = [](const TuneFigures& figures) {
    const double count = std::max<double>(1, figures.alarms.Total());
    return figures.dispersion * count / (figures.vehicle_hours * figures.vehicle_hours);
  };
  return than.alarms_per_hour - one.alarms_per_hour > 2 * std::sqrt(variance(one) + variance(than));
}

bool NoticesNoLater(const TuneFigures& one, const TuneFigures& than) {
  if (one.undetected > 0) return false;
  const double error = std::hypot(one.detection_error_ms, than.detection_error_ms);
  const double chance = std::clamp(2 * error, kSameDetectionMs, kMostChanceMs);
  return Detection(one) <= Detection(than) + chance;
}

std::size_t Recommended(const std::vector<TuneFigures>& figures, std::size_t base) {
  std::vector<std::size_t> better;
  for (std::size_t i = 0; i < figures.size(); ++i) {
    if (i != base && HasFewerAlarms(figures[i], figures[base]) &&
        NoticesNoLater(figures[i], figures[base])) {
      better.push_back(i);
    }
  }
  const auto fewest = [&](std::size_t place) { return TieBreak(figures[place]); };
  if (better.empty()) {
    std::vector<std::size_t> sure = AllPlaces(figures);
    std::erase_if(sure, [&](std::size_t place) { return figures[place].undetected > 0; });
    return sure.empty() ? base : *std::ranges::min_element(sure, {}, fewest);
  }
  const auto detection = [&](std::size_t place) { return Detection(figures[place]); };
  const double first = detection(*std::ranges::min_element(better, {}, detection));
  std::erase_if(better,
                [&](std::size_t place) { return detection(place) > first + kSameDetectionMs; });
  return *std::ranges::min_element(better, {}, fewest);
}

}  // namespace giveway::fleetctl
