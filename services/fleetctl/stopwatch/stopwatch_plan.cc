#include "services/fleetctl/stopwatch/stopwatch_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/types/math/random.h"

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Nanoseconds kFirstCut = seconds(5);  // after the start signal: discovery takes a second
constexpr Nanoseconds kAfterward = milliseconds(1500);  // late events are still reported
constexpr double kCell_m = 5;                           // between two squares
constexpr double kSquare_m = 1;

std::vector<FaultInjection> PlanInjections(std::vector<VehicleId> fleet, std::size_t targets,
                                           Random* dice) {
  std::vector<FaultInjection> injections;
  for (std::size_t i = 0; i < targets; ++i) {
    const auto other = static_cast<std::size_t>(
        dice->Uniform(static_cast<double>(i), static_cast<double>(fleet.size())));
    std::swap(fleet[i], fleet[other]);
    const Nanoseconds exact = FromSeconds(dice->Uniform(0, Seconds(kWaveSpread)));
    // Whole milliseconds, as in a vehicle's blackouts.
    injections.push_back({fleet[i], std::chrono::floor<milliseconds>(exact)});
  }
  std::ranges::sort(injections, {}, &FaultInjection::after);
  return injections;
}

Nanoseconds LongestPromise(const Limits& limits) {
  Nanoseconds longest{0};
  for (std::size_t i = 0; i < kMechanisms; ++i) {
    longest = std::max(longest, PromisedWithin(static_cast<Mechanism>(i), limits));
  }
  return longest;
}

// "3.250s..15s": when the vehicle is faulted, in each wave.
std::vector<std::string> WindowsOf(VehicleId target, std::span<const Wave> waves) {
  std::vector<std::string> windows;
  for (const Wave& wave : waves) {
    for (const FaultInjection& injection : wave.injections) {
      if (injection.target != target) continue;
      windows.push_back(fmt::format("blackout={:.3f}s..{:.3f}s",
                                    Seconds(wave.begin + injection.after), Seconds(wave.end)));
    }
  }
  return windows;
}

}  // namespace

std::vector<VehicleId> StopwatchVehicles(std::uint32_t count) {
  std::vector<VehicleId> fleet;
  for (std::uint32_t i = 1; i <= count; ++i) fleet.push_back(VehicleId{i});
  return fleet;
}

std::uint32_t TargetsOf(std::size_t fleet) {
  return static_cast<std::uint32_t>(std::max<std::size_t>(1, fleet / 2));
}

std::vector<Wave> PlanWaves(Fault fault, std::uint32_t trials, std::span<const VehicleId> fleet,
                            const Limits& limits, std::uint64_t seed) {
  Random dice(seed, static_cast<std::uint64_t>(fault));
  const Nanoseconds length = kWaveSpread + LongestPromise(limits) + kAfterward;
  std::vector<Wave> waves;
  for (std::uint32_t left = trials; left > 0;) {
    const std::uint32_t injected = std::min(left, TargetsOf(fleet.size()));
    waves.push_back({kFirstCut, kFirstCut + length,
                     PlanInjections({fleet.begin(), fleet.end()}, injected, &dice)});
    left -= injected;
  }
  return waves;
}

std::string BlackoutsOf(VehicleId hearer, Fault fault, std::span<const Wave> waves,
                        std::span<const VehicleId> fleet) {
  if (!IsCut(fault)) return {};
  std::string rules;
  for (const VehicleId sender : fleet) {
    if (sender == hearer) continue;
    std::vector<std::string> windows = WindowsOf(sender, waves);
    if (fault == Fault::kCut)
      std::ranges::copy(WindowsOf(hearer, waves), std::back_inserter(windows));
    if (windows.empty()) continue;
    if (!rules.empty()) rules += ';';
    rules += fmt::format("from={},{}", Number(sender), fmt::join(windows, ","));
  }
  return rules;
}

std::string StopwatchScenario(std::span<const VehicleId> fleet) {
  // Open, by a place that stays free: a closed fleet's run ends when a vehicle is gone.
  std::string text = fmt::format(
      "name: \"stopwatch\"\nduration_s: 86400\nremove_after_s: 3600\nemission_radius_m: 1000\n"
      "start_with: {}\nspawn {{ start {{ x_m: -50 y_m: -50 heading_deg: 0 }} cruise_m_s: 0.2 }}\n"
      "expect {{ contacts: 0 }}\n",
      fleet.size());
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(fleet.size())));
  for (std::size_t i = 0; i < fleet.size(); ++i) {
    const double x = static_cast<double>(i % columns) * kCell_m;
    const double y = static_cast<double>(i / columns) * kCell_m;
    text += fmt::format(
        "vehicle {{ id: {} start {{ x_m: {} y_m: {} heading_deg: 0 }} cruise_m_s: 0.2 loop: true",
        Number(fleet[i]), x, y);
    for (const auto& [dx, dy] : {std::pair(kSquare_m, 0.0), std::pair(kSquare_m, kSquare_m),
                                 std::pair(0.0, kSquare_m), std::pair(0.0, 0.0)}) {
      text += fmt::format(" waypoint {{ x_m: {} y_m: {} }}", x + dx, y + dy);
    }
    text += " }\n";
  }
  return text;
}

}  // namespace giveway::fleetctl
