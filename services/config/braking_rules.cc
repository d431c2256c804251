#include "services/config/braking_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "services/types/math/math.h"

namespace giveway {
namespace {

// A seed makes a vehicle faster by up to so much (PerturbBySeed, scenario_overrides.h).
constexpr double kSeedSpread = 1.02;

double Fastest(const VehicleOptions& vehicle) {
  return std::min(kSeedSpread * vehicle.cruise_m_s, vehicle.profile.max_speed_m_s);
}

// From cruise speed.
double BrakingDistance(const VehicleOptions& vehicle) {
  return Fastest(vehicle) * Fastest(vehicle) / (2 * vehicle.profile.deceleration_m_s2);
}

// From what a scan or a beacon shows until the brakes act, without the beacon's transit: the
// decision of one tick acts in the next, on readings that may be older by the ultrasonics' refresh.
double ReactionSeconds(const VehicleOptions& vehicle) {
  return 2 * Seconds(vehicle.tick_period) + Seconds(vehicle.sonar_refresh);
}

// A refused number is a problem already.
bool IsSound(const VehicleOptions& vehicle) {
  const double sum = vehicle.cruise_m_s + vehicle.profile.body_radius_m +
                     vehicle.profile.deceleration_m_s2 + vehicle.emission_radius_m +
                     vehicle.gate_enter_m;
  return std::isfinite(sum) && vehicle.profile.deceleration_m_s2 > 0;
}

double LongestDelay(const Scenario& scenario) {
  double longest_s = 0;
  for (const ImpairmentRule& rule : scenario.impairment.rules) {
    const double delay_s = rule.delay_s + rule.jitter_s;
    if (rule.from != ImpairedSender::kWorld && std::isfinite(delay_s)) {
      longest_s = std::max(longest_s, delay_s);
    }
  }
  return longest_s;
}

// Every vehicle that drives, in the order of the file's kinds.
struct Driver {
  const VehicleOptions* options;
  const Section* section;
  std::string name;
  bool is_one_of_many = false;  // of a place from which several may come, one after the other
};

std::vector<Driver> DriversOf(const ReadScenario& read) {
  std::vector<Driver> drivers;
  const auto add = [&](const VehicleOptions& options, const Section& section, std::string name,
                       bool is_one_of_many) {
    if (!IsSound(options)) return;
    drivers.push_back({&options, &section, std::move(name), is_one_of_many});
  };
  const Scenario& scenario = read.scenario;
  for (std::size_t i = 0; i < read.vehicles.size(); ++i) {
    const VehicleOptions& vehicle = scenario.vehicles[i];
    add(vehicle, read.vehicles[i], fmt::format("vehicle {}", Number(vehicle.id)), false);
  }
  for (std::size_t i = 0; i < read.spawns.size(); ++i) {
    const VehicleOptions& place = scenario.spawns[i];
    add(place, read.spawns[i], fmt::format("spawn[{}]", i), !place.route.loop);
  }
  return drivers;
}

void AddPairError(const Driver& own, const Driver& peer, const BrakingSum& sum) {
  own.section->AddError(
      "cruise_m_s",
      fmt::format("{} at {:.3g} m/s and {} at {:.3g} m/s (a seed's 2 % included) could not stop "
                  "before they touch: braking {:.2f} "
                  "+ {:.2f} m (at {:.3g} and {:.3g} m/s^2), {:.2f} m in the {:.0f} ms until both "
                  "brake, and "
                  "{:.2f} m of bodies are {:.2f} m, but they hear each other within {:.2f} m "
                  "(emission_radius_m), and ultrasonics stop them {:.2f} m apart (gate_enter_m)",
                  own.name, Fastest(*own.options), peer.name, Fastest(*peer.options), sum.own_m,
                  sum.peer_m, own.options->profile.deceleration_m_s2,
                  peer.options->profile.deceleration_m_s2, sum.reaction_m, 1000 * sum.reaction_s,
                  sum.bodies_m, sum.NeededCentres(), sum.radio_m, sum.sonar_m),
      fmt::format(
          "lower cruise_m_s, raise profile.deceleration_m_s2, or raise emission_radius_m to "
          "at least {:.2f}",
          std::ceil(100 * sum.NeededCentres()) / 100));
}

// A vehicle is blamed on account of one that needs no more than itself, so that one that is too
// fast is not blamed on all others.
void CheckPairs(const std::vector<Driver>& drivers, double delay_s) {
  const auto alone_m = [&](const Driver& driver) {
    return SumOf(*driver.options, *driver.options, delay_s).NeededCentres();
  };
  std::vector<double> needs_m;
  for (const Driver& driver : drivers) needs_m.push_back(alone_m(driver));
  std::vector<std::size_t> order(drivers.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater<>{}, [&](std::size_t i) { return needs_m[i]; });
  for (std::size_t k = 0; k < order.size(); ++k) {
    const Driver& own = drivers[order[k]];
    // Where two of the faster can stop for each other, so can any two of the rest.
    if (SumOf(*own.options, *own.options, delay_s).NeededCentres() <=
        own.options->emission_radius_m) {
      break;
    }
    const auto refuse = [&](const Driver& peer) {
      const BrakingSum sum = SumOf(*own.options, *peer.options, delay_s);
      if (sum.ComesOut()) return false;
      AddPairError(own, peer, sum);
      return true;
    };
    const auto slower = std::span(order).subspan(k + 1);
    const bool refused =
        std::ranges::any_of(slower, [&](std::size_t i) { return refuse(drivers[i]); });
    if (refused || !own.is_one_of_many) continue;
    Driver another = own;
    another.name = "another of " + own.name;
    refuse(another);
  }
}

// Whether anything in the place may show no more than an edge: discs are faces from every side.
bool HasEdges(const Scenario& scenario) {
  const auto is_box = [](const Obstacle& obstacle) { return obstacle.shape == BodyShape::kBox; };
  return !scenario.walls.empty() || !scenario.doors.empty() ||
         std::ranges::any_of(scenario.obstacles, is_box);
}

double NeededForStanding(const VehicleOptions& own) {
  return BrakingDistance(own) + Fastest(own) * ReactionSeconds(own);
}

void CheckStanding(const Driver& driver, SonarTier tier) {
  const VehicleOptions& own = *driver.options;
  if (CanStopForStanding(own, tier)) return;
  const double reaction_s = ReactionSeconds(own);
  const double needed_m = NeededForStanding(own);
  driver.section->AddError(
      "cruise_m_s",
      fmt::format("{} at {:.3g} m/s (a seed's 2 % included) could not stop before a wall or an "
                  "obstacle: braking "
                  "{:.2f} m (at {:.3g} m/s^2) and {:.2f} m in the {:.0f} ms until it brakes "
                  "are {:.2f} m, but its ultrasonics surely hear what stands ahead from {:.2f} m",
                  driver.name, Fastest(own), BrakingDistance(own), own.profile.deceleration_m_s2,
                  Fastest(own) * reaction_s, 1000 * reaction_s, needed_m, SureReach(own, tier)),
      "lower cruise_m_s, or raise profile.deceleration_m_s2");
}

// Outside on one side it hears who is in, on the other side, while it can still stop.
double NeededForOneLane(const OneLane& lane, const VehicleOptions& own, double widest_m) {
  const double outside_m =
      lane.width_m + own.profile.body_radius_m + widest_m + 2 * kOneLaneMargin_m;
  const double stops_m =
      BrakingDistance(own) + Fastest(own) * (ReactionSeconds(own) + kOneLaneHeard_s);
  return Norm(lane.to_world - lane.from_world) + outside_m + stops_m;
}

void CheckOneLane(const Section& section, const OneLane& lane, const std::vector<Driver>& drivers) {
  double widest_m = 0;
  for (const Driver& driver : drivers) {
    widest_m = std::max(widest_m, driver.options->profile.body_radius_m);
  }
  for (const Driver& driver : drivers) {
    const VehicleOptions& own = *driver.options;
    const double needed_m = NeededForOneLane(lane, own, widest_m);
    if (!(needed_m > own.emission_radius_m)) continue;
    section.AddError(
        "to",
        fmt::format(
            "{} could not stop outside it for one that is in: it is {:.2f} m long, braking, "
            "two bodies and half of its width at either end make {:.2f} m, but they hear "
            "each other within {:.2f} m (emission_radius_m)",
            driver.name, Norm(lane.to_world - lane.from_world), needed_m, own.emission_radius_m),
        fmt::format("shorten it, or raise emission_radius_m to at least {:.2f}",
                    std::ceil(100 * needed_m) / 100));
    return;
  }
}

}  // namespace

BrakingSum SumOf(const VehicleOptions& own, const VehicleOptions& peer, double delay_s) {
  BrakingSum sum;
  sum.own_m = BrakingDistance(own);
  sum.peer_m = BrakingDistance(peer);
  sum.reaction_s =
      std::max(ReactionSeconds(own), ReactionSeconds(peer)) + Seconds(own.tick_period) + delay_s;
  sum.reaction_m = (Fastest(own) + Fastest(peer)) * sum.reaction_s;
  sum.bodies_m = own.profile.body_radius_m + peer.profile.body_radius_m;
  sum.radio_m = std::min(own.emission_radius_m, peer.emission_radius_m);
  sum.sonar_m = std::min({own.gate_enter_m, peer.gate_enter_m, own.profile.sonar_max_range_m,
                          peer.profile.sonar_max_range_m});
  return sum;
}

double SureReach(const VehicleOptions& own, SonarTier tier) {
  if (tier == SonarTier::kIdeal) return own.profile.sonar_max_range_m;
  // Straight ahead lies midway between these two; see RobotModel::sonar.
  const SensorMount& left = own.profile.sonar[3];
  const SensorMount& right = own.profile.sonar[4];
  const double midway_rad = (left.bearing_rad - right.bearing_rad) / 2;
  const double sine = Sin(midway_rad) / Sin(own.profile.sonar_half_angle_rad);
  const double from_mount_m = EdgeReachOff(EdgeReach(tier), std::min(1.0, sine * sine));
  const double mount_m = std::min(left.position_body.x, right.position_body.x);
  return std::clamp(from_mount_m + mount_m - own.profile.body_radius_m, 0.0,
                    own.profile.sonar_max_range_m);
}

bool CanStopForStanding(const VehicleOptions& own, SonarTier tier) {
  return NeededForStanding(own) <= SureReach(own, tier);
}

void CheckBraking(const ReadScenario& read) {
  const std::vector<Driver> drivers = DriversOf(read);
  CheckPairs(drivers, LongestDelay(read.scenario));
  const Scenario& scenario = read.scenario;
  for (std::size_t i = 0; i < read.one_lanes.size(); ++i) {
    CheckOneLane(read.one_lanes[i], scenario.one_lanes[i], drivers);
  }
  if (scenario.walls.empty() && scenario.obstacles.empty() && scenario.doors.empty()) return;
  const SonarTier tier = HasEdges(scenario) ? scenario.sonar.tier : SonarTier::kIdeal;
  for (const Driver& driver : drivers) CheckStanding(driver, tier);
}

}  // namespace giveway
