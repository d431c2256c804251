#include "tests/bench/baseline_reservation.h"

#include <algorithm>
#include <numeric>

#include "services/types/check.h"
#include "services/types/math.h"
#include "tests/bench/baseline_clearance.h"

namespace giveway::bench {
namespace {

constexpr double kRoundTheField_m = 1.5;

Ground GroundOf(const Scenario& scenario, double tile_m) {
  Ground ground = {scenario.vehicles.front().start_world.position_world,
                   scenario.vehicles.front().start_world.position_world, tile_m};
  const auto include = [&](Vec2 at) {
    ground.low_world = {std::min(ground.low_world.x, at.x), std::min(ground.low_world.y, at.y)};
    ground.high_world = {std::max(ground.high_world.x, at.x), std::max(ground.high_world.y, at.y)};
  };
  for (const VehicleOptions& options : scenario.vehicles) {
    include(options.start_world.position_world);
    include(options.goal.at_world);
  }
  const Vec2 round{kRoundTheField_m, kRoundTheField_m};
  return {ground.low_world - round, ground.high_world + round, tile_m};
}

// As far beyond the goal as braking may take it.
double BrakingBeyond_m(const VehicleOptions& options) {
  const double cruise = options.cruise_m_s;
  return cruise * cruise / (2 * options.profile.deceleration_m_s2) + cruise;
}

double WayAlone_m(const VehicleOptions& options) {
  return Norm(options.goal.at_world - options.start_world.position_world);
}

double DistanceFromWay(const VehicleOptions& options, Vec2 point) {
  const Vec2 from = options.start_world.position_world;
  const Vec2 way = options.goal.at_world - from;
  const double share = std::clamp(Dot(point - from, way) / SquaredNorm(way), 0.0, 1.0);
  return Norm(point - from - share * way);
}

// Where on its way `a` comes to the way of `b`, if they cross.
std::optional<double> CrossingAt(const VehicleOptions& a, const VehicleOptions& b) {
  const Vec2 from = a.start_world.position_world;
  const Vec2 way = a.goal.at_world - from;
  const Vec2 other_from = b.start_world.position_world;
  const Vec2 other_way = b.goal.at_world - other_from;
  const double turn = Cross(way, other_way);
  if (turn * turn < 1e-6 * SquaredNorm(way) * SquaredNorm(other_way)) return std::nullopt;
  const double mine = Cross(other_from - from, other_way) / turn;
  const double others = Cross(other_from - from, way) / turn;
  if (mine < 0 || mine > 1 || others < 0 || others > 1) return std::nullopt;
  return mine * Norm(way);
}

}  // namespace

Reservation::Reservation(const Scenario& scenario, const ReservationSettings& settings)
    : settings_(settings),
      last_step_(static_cast<Step>(scenario.duration_s / Seconds(scenario.tick_period)) /
                 kTicksAStep),
      book_(GroundOf(scenario, settings.tile_m)) {
  for (const VehicleOptions& options : scenario.vehicles) {
    members_.push_back(
        {.options = options,
         .pace = PaceOf(options),
         .way = StraightWay(options.start_world, WayAlone_m(options) + BrakingBeyond_m(options))});
  }
  PutInOrder();
  for (const Member& member : members_) {
    GIVEWAY_CHECK(book_.BookFrom(TilesAt(member, 0), 0), Number(member.options.id));
  }
  Serve();
}

double Reservation::Radius(const Member& member) const {
  return member.options.profile.body_radius_m + settings_.margin_m / 2;
}

std::vector<Tile> Reservation::TilesAt(const Member& member, double driven_m) const {
  std::vector<Tile> tiles;
  book_.TilesUnder(member.way.PoseAt(driven_m).position_world, Radius(member), &tiles);
  return tiles;
}

// First come, first served; but who stands in the way of another, or has to pass where another will
// stay, is served before it.
void Reservation::PutInOrder() {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const VehicleOptions& own = members_[i].options;
    double comes_m = WayAlone_m(own);
    for (std::size_t j = 0; j < members_.size(); ++j) {
      if (i == j) continue;
      const VehicleOptions& other = members_[j].options;
      comes_m = std::min(comes_m, CrossingAt(own, other).value_or(comes_m));
      const double near_m = Radius(members_[i]) + Radius(members_[j]);
      const bool stands_in_way = DistanceFromWay(own, other.start_world.position_world) < near_m;
      const bool ends_in_way = DistanceFromWay(other, own.goal.at_world) < near_m;
      if (stands_in_way || ends_in_way) members_[i].waits_for.push_back(j);
    }
    members_[i].comes_s = comes_m / own.cruise_m_s;
  }
}

bool Reservation::MayAsk(const Member& member) const {
  return std::ranges::all_of(member.waits_for,
                             [&](std::size_t other) { return members_[other].passage.has_value(); });
}

void Reservation::Serve() {
  std::vector<std::size_t> waiting(members_.size());
  std::iota(waiting.begin(), waiting.end(), std::size_t{0});
  std::ranges::stable_sort(waiting, {}, [&](std::size_t i) { return members_[i].comes_s; });
  while (!waiting.empty()) {
    const auto asks = [&](std::size_t i) { return MayAsk(members_[i]); };
    auto next = std::ranges::find_if(waiting, asks);
    if (next != waiting.end() && Serve(&members_[*next])) {
      waiting.erase(next);
      continue;
    }
    // A circle of those who wait for each other: whoever can go goes.
    next = std::ranges::find_if(waiting, [&](std::size_t i) { return Serve(&members_[i]); });
    if (next == waiting.end()) return;
    waiting.erase(next);
  }
}

bool Reservation::Serve(Member* member) {
  const std::vector<Tile> start = TilesAt(*member, 0);
  book_.GiveBack(start);
  Clearance clearance(member->way, member->pace, book_, Radius(*member));
  const double arrive_m = WayAlone_m(member->options) - member->options.goal.radius_m;
  member->passage = SoonestPassage(
      member->pace,
      {.arrive_unit = static_cast<std::uint32_t>(arrive_m / member->pace.unit_m) + 1,
       .last_unit = clearance.LastUnit(),
       .last_step = last_step_,
       .free_during = [&](Step step) -> const FreeUnits& { return clearance.During(step); },
       .may_stay = [&](std::uint32_t unit, Step step) { return clearance.MayStay(unit, step); }});
  if (member->passage) {
    Book(*member);
  } else {
    GIVEWAY_CHECK(book_.BookFrom(start, 0), Number(member->options.id));
  }
  return member->passage.has_value();
}

void Reservation::Book(const Member& member) {
  const Passage& passage = *member.passage;
  const auto last = static_cast<Step>(passage.units.size() - 1);
  for (Step step = 1; step <= last; ++step) {
    const double from_m = passage.units[step - 1] * member.pace.unit_m;
    const double to_m = passage.units[step] * member.pace.unit_m;
    std::vector<Tile> tiles;
    for (const double share : {0.0, 1.0 / 3, 2.0 / 3, 1.0}) {
      const std::vector<Tile> under = TilesAt(member, from_m + share * (to_m - from_m));
      tiles.insert(tiles.end(), under.begin(), under.end());
    }
    std::ranges::sort(tiles);
    tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
    GIVEWAY_CHECK(book_.Book(tiles, step), Number(member.options.id), step);
  }
  GIVEWAY_CHECK(
      book_.BookFrom(TilesAt(member, passage.units.back() * member.pace.unit_m), last + 1),
      Number(member.options.id));
}

std::size_t Reservation::Refused() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(members_, [](const Member& member) { return !member.passage; }));
}

void Reservation::Drive(std::uint32_t tick, std::span<const Seen> fleet,
                        std::span<WheelSpeeds> wheels) {
  static_cast<void>(fleet);
  const Step step = tick / kTicksAStep;
  const double share = static_cast<double>(tick % kTicksAStep + 1) / kTicksAStep;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    wheels[i] = {};
    const std::optional<Passage>& passage = members_[i].passage;
    if (!passage || step + 1 >= passage->levels.size()) continue;
    const double from = passage->levels[step];
    const double to = passage->levels[step + 1];
    const double speed_m_s = (from + share * (to - from)) * members_[i].pace.level_m_s;
    wheels[i] = WheelsFromTwist(members_[i].options.profile.drive, {speed_m_s, 0});
  }
}

}  // namespace giveway::bench
