#include "tests/bench/baseline/reservation.h"

#include <algorithm>
#include <numeric>

#include "services/types/check.h"
#include "services/types/math/math.h"
#include "tests/bench/baseline/clearance.h"
#include "tests/bench/baseline/follow.h"

namespace giveway::bench {
namespace {

constexpr double kRoundTheField_m = 2;

Ground GroundOf(const Scenario& scenario, double tile_m) {
  const Vec2 anyone = scenario.vehicles.front().start_world.position_world;
  Ground ground = {anyone, anyone, tile_m};
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
  constexpr double kLastStep_s = 0.5;
  return cruise * cruise / (2 * options.profile.deceleration_m_s2) + kLastStep_s * cruise;
}

ArcPath PathAlone(const VehicleOptions& options) {
  const double to_goal_m = Norm(options.goal.at_world - options.start_world.position_world);
  return StraightPath(options.start_world, to_goal_m + BrakingBeyond_m(options));
}

Step TurnSteps(const VehicleOptions& options, const ArcPath& path) {
  const double turn = WrapAngle(path.PoseAt(0).heading_rad - options.start_world.heading_rad);
  const double step_s = kTicksAStep * Seconds(options.tick_period);
  return static_cast<Step>(SecondsToTurn(options.profile, turn) / step_s + 0.999);
}

// Within a step speed changes by as much in every tick; a tick moves by the speed at its end.
Planned PlannedAt(const Passage& passage, const Pace& pace, std::uint32_t tick) {
  const Step step = tick / kTicksAStep;
  const double ticks = tick % kTicksAStep;  // of the step, gone by
  const double from = passage.levels[step];
  const double gain = (passage.levels[step + 1] - from) / kTicksAStep;
  const double units = passage.units[step] + ticks * from + gain * ticks * (ticks + 1) / 2;
  return {.driven_m = units * pace.unit_m,
          .speed_m_s = (from + gain * (ticks + 1)) * pace.level_m_s};
}

// When it has driven so far, in seconds.
double PassesAt(const Passage& passage, const Pace& pace, double driven_m) {
  const auto there = std::ranges::lower_bound(passage.units, driven_m / pace.unit_m);
  const double step_s = kTicksAStep * pace.unit_m / pace.level_m_s;
  return step_s * static_cast<double>(there - passage.units.begin());
}

double LargestBody_m(const Scenario& scenario) {
  double largest_m = 0;
  for (const VehicleOptions& options : scenario.vehicles) {
    largest_m = std::max(largest_m, options.profile.body_radius_m);
  }
  return largest_m;
}

}  // namespace

Reservation::Reservation(const Scenario& scenario, const ReservationSettings& settings)
    : settings_(settings),
      last_step_(static_cast<Step>(scenario.duration_s / Seconds(scenario.tick_period)) /
                 kTicksAStep),
      book_(GroundOf(scenario, settings.tile_m)) {
  std::vector<Arrival> arrivals =
      ArrivalsOf(scenario, 2 * LargestBody_m(scenario) + settings.margin_m);
  for (std::size_t i = 0; i < scenario.vehicles.size(); ++i) {
    const VehicleOptions& options = scenario.vehicles[i];
    members_.push_back({options, PaceOf(options), std::move(arrivals[i]), PathAlone(options), {}});
    GIVEWAY_CHECK(book_.BookFrom(TilesAt(members_.back(), 0), 0), Number(options.id));
  }
  ServeEveryone();
}

double Reservation::Radius(const Member& member) const {
  return member.options.profile.body_radius_m + settings_.margin_m / 2;
}

std::vector<Tile> Reservation::TilesAt(const Member& member, double driven_m) const {
  std::vector<Tile> tiles;
  book_.TilesUnder(member.path.PoseAt(driven_m).position_world, Radius(member), &tiles);
  return tiles;
}

bool Reservation::MayAsk(const Member& member) const {
  return std::ranges::all_of(member.arrival.let_first,
                             [&](std::size_t i) { return members_[i].passage.has_value(); });
}

// First come, first served; but in a lane the vehicle ahead is served before those behind it.
void Reservation::ServeEveryone() {
  std::vector<std::size_t> waiting(members_.size());
  std::iota(waiting.begin(), waiting.end(), std::size_t{0});
  while (!waiting.empty()) {
    std::ranges::stable_sort(waiting, {},
                             [&](std::size_t i) { return members_[i].arrival.comes_s; });
    auto next = std::ranges::find_if(waiting, [&](std::size_t i) { return MayAsk(members_[i]); });
    // All wait for each other: the first to come starts.
    if (next == waiting.end()) next = waiting.begin();
    if (!Serve(&members_[*next])) {
      next = std::ranges::find_if(waiting, [&](std::size_t i) { return Serve(&members_[i]); });
      if (next == waiting.end()) return;
    }
    HoldBackThoseBehind(*next);
    waiting.erase(next);
  }
}

// A vehicle behind another in a lane reaches the crossing no sooner than the other has moved on by
// a body's length.
void Reservation::HoldBackThoseBehind(std::size_t ahead) {
  const Member& first = members_[ahead];
  const double gone_m = first.arrival.comes_m + 2 * Radius(first);
  const double gone_s = PassesAt(*first.passage, first.pace, gone_m);
  for (Member& behind : members_) {
    if (std::ranges::find(behind.arrival.let_first, ahead) == behind.arrival.let_first.end()) {
      continue;
    }
    behind.arrival.comes_s = std::max(behind.arrival.comes_s, gone_s);
  }
}

std::vector<Standing> Reservation::StandingBeside(const Member& member) const {
  std::vector<Standing> standing;
  for (const Member& other : members_) {
    if (&other == &member) continue;
    const double rest_m = other.passage ? other.passage->units.back() * other.pace.unit_m : 0;
    // Discs that far apart touch no tile both, wherever between its samples a clearance looks.
    const double apart_m = Sqrt(2) * settings_.tile_m + kSample_m;
    standing.push_back(
        {other.path.PoseAt(rest_m).position_world, Radius(member) + Radius(other) + apart_m});
  }
  return standing;
}

bool Reservation::Try(const ArcPath& path, Step last_step, Member* member) const {
  Clearance clearance(path, member->pace, book_, Radius(*member));
  const double arrive_m =
      path.Length_m() - BrakingBeyond_m(member->options) - member->options.goal.radius_m;
  std::optional<Passage> passage = SoonestPassage(
      member->pace,
      {.first_step = TurnSteps(member->options, path),
       .arrive_unit = static_cast<std::uint32_t>(arrive_m / member->pace.unit_m) + 1,
       .last_unit = clearance.LastUnit(),
       .last_step = last_step,
       .free_during = [&](Step step) -> const FreeUnits& { return clearance.During(step); },
       .may_stay = [&](std::uint32_t unit, Step step) { return clearance.MayStay(unit, step); }});
  if (!passage) return false;
  member->passage = std::move(passage);
  member->path = path;
  return true;
}

bool Reservation::Serve(Member* member) {
  const std::vector<Tile> start = TilesAt(*member, 0);
  book_.GiveBack(start);
  const std::optional<ArcPath> round =
      PathAround(member->options.start_world.position_world, member->options.goal.at_world,
                 StandingBeside(*member), BrakingBeyond_m(member->options));
  if (round) Try(*round, last_step_, member);
  const ArcPath alone = PathAlone(member->options);
  constexpr double kSame_m = 1e-6;
  if (!round || round->Length_m() > alone.Length_m() + kSame_m) {
    // Straight past vehicles that block the path only for a time, if that is sooner.
    Try(alone, member->passage ? member->passage->arrival_step - 1 : last_step_, member);
  }
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
  const double rest_m = passage.units.back() * member.pace.unit_m;
  GIVEWAY_CHECK(book_.BookFrom(TilesAt(member, rest_m), last + 1), Number(member.options.id));
}

std::size_t Reservation::Refused() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(members_, [](const Member& member) { return !member.passage; }));
}

void Reservation::Drive(std::uint32_t tick, std::span<const Seen> fleet,
                        std::span<WheelSpeeds> wheels) {
  const Step step = tick / kTicksAStep;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    wheels[i] = {};
    const Member& member = members_[i];
    if (!member.passage || step + 1 >= member.passage->levels.size()) continue;
    wheels[i] = FollowPath(member.options.profile, member.path,
                           PlannedAt(*member.passage, member.pace, tick), fleet[i].world_from_body);
  }
}

}  // namespace giveway::bench
