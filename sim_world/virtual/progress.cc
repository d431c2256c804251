#include "sim_world/virtual/progress.h"

#include <algorithm>
#include <numeric>

#include "services/types/math/math.h"
#include "services/types/time.h"
#include "sim_world/dynamics/doors.h"
namespace giveway::sim {
namespace {

constexpr double kNearer_m = 0.1;  // less may be the turning of a stuck vehicle
constexpr double kNearerTime_s =
    10;  // and a slow one needs no more of it than it drives in so long
// A vehicle on a detour skips a waypoint that it cannot reach within 1.2 m (services/vehicle).
constexpr double kPassed_m = 1.3;
// Centre to centre: from a door or a dead vehicle, which no vehicle reports to wait for.
constexpr double kNear_m = 1.7;
constexpr std::uint32_t kNoTrack = 0xffffffff;

double DistanceToDoor(Vec2 point_world, const Door& door) {
  const Vec2 along = door.to_world - door.from_world;
  const double share =
      std::clamp(Dot(point_world - door.from_world, along) / SquaredNorm(along), 0.0, 1.0);
  return Norm(point_world - (door.from_world + share * along));
}

bool IsInCrowd(const Observed& vehicle) { return vehicle.present && !vehicle.arrived; }

}  // namespace

Progress::Progress(const Scenario& scenario, double limit_s)
    : doors_(scenario.doors),
      limit_ticks_(TicksCovering(FromSeconds(limit_s), scenario.tick_period)),
      second_ticks_(TicksCovering(FromSeconds(1), scenario.tick_period)) {
  for (const VehicleOptions& options : scenario.vehicles) tracks_.push_back(TrackOf(options));
}

Progress::Track Progress::TrackOf(const VehicleOptions& options) {
  Track track{.vehicle = options.id,
              .goal = options.goal,
              .route = options.route,
              .nearer_m = std::min(kNearer_m, kNearerTime_s * options.cruise_m_s)};
  track.goal.set = HasGoal(options);
  return track;
}

void Progress::Admit(const VehicleOptions& options) {
  const auto place = std::ranges::lower_bound(tracks_, options.id, {}, &Track::vehicle);
  if (place != tracks_.end() && place->vehicle == options.id) {
    *place = TrackOf(options);
  } else {
    tracks_.insert(place, TrackOf(options));
  }
}

void Progress::Forget(VehicleId vehicle) {
  std::erase_if(tracks_, [vehicle](const Track& track) { return track.vehicle == vehicle; });
}

std::uint32_t Progress::IndexOf(VehicleId vehicle) const {
  const auto found = std::ranges::lower_bound(tracks_, vehicle, {}, &Track::vehicle);
  if (found == tracks_.end() || found->vehicle != vehicle) return kNoTrack;
  return static_cast<std::uint32_t>(found - tracks_.begin());
}

// A vehicle without a destination drives straight on: it makes progress while it moves.
bool Progress::MakesProgress(const Observed& now, Track* track) const {
  const Route& route = track->route;
  bool passed = !track->under_way;
  track->under_way = true;
  for (std::uint32_t i = 0; i < route.count && track->waypoint < route.count; ++i) {
    const Vec2 next = route.waypoints_world[track->waypoint];
    if (Norm(next - now.position_world) > std::max(kPassed_m, route.radius_m)) break;
    passed = true;
    ++track->waypoint;
    if (route.loop && track->waypoint == route.count) track->waypoint = 0;
  }
  const bool on_route = track->waypoint < route.count;
  if (!on_route && !track->goal.set) return Magnitude(now.forward_m_s) >= kStandstill_m_s;
  const Vec2 next = on_route ? route.waypoints_world[track->waypoint] : track->goal.at_world;
  const double away_m = Norm(next - now.position_world);
  if (!passed && away_m > track->nearest_m - track->nearer_m) return false;
  track->nearest_m = away_m;
  return true;
}

bool Progress::IsExcused(const Observed& now, double time_s, bool red) const {
  if (!now.lives || now.decision.rule == Rule::kNotRunning) return true;
  if (now.decision.rule == Rule::kLost) return true;  // it reports this, and waits for a fix
  if (red && now.decision.rule == Rule::kSignal) return true;
  return std::ranges::any_of(doors_, [&](const Door& door) {
    return SlidingDoor(door).PlannedOpening(time_s) < 1 &&
           DistanceToDoor(now.position_world, door) <= kNear_m;
  });
}

std::uint32_t Progress::CrowdOf(std::uint32_t vehicle) {
  while (crowd_[vehicle] != vehicle) {
    crowd_[vehicle] = crowd_[crowd_[vehicle]];
    vehicle = crowd_[vehicle];
  }
  return vehicle;
}

void Progress::Join(std::uint32_t a, std::uint32_t b) {
  a = CrowdOf(a);
  b = CrowdOf(b);
  const std::uint32_t first = std::min(a, b);
  crowd_[a] = first;
  crowd_[b] = first;
  crowd_progress_[first] = std::max(crowd_progress_[a], crowd_progress_[b]);
}

void Progress::FindCrowds(std::span<const Observed> vehicles) {
  const auto count = static_cast<std::uint32_t>(vehicles.size());
  crowd_.resize(count);
  std::iota(crowd_.begin(), crowd_.end(), 0U);
  crowd_progress_.clear();
  for (const Track& track : tracks_) crowd_progress_.push_back(track.progress);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!IsInCrowd(vehicles[i])) continue;
    for (const VehicleId other : {vehicles[i].decision.peer, vehicles[i].gives_way_to}) {
      const std::uint32_t named = IndexOf(other);
      if (named != kNoTrack && IsInCrowd(vehicles[named])) Join(i, named);
    }
    if (vehicles[i].lives) continue;
    for (std::uint32_t j = 0; j < count; ++j) {
      const Vec2 apart = vehicles[i].position_world - vehicles[j].position_world;
      if (IsInCrowd(vehicles[j]) && SquaredNorm(apart) <= kNear_m * kNear_m) Join(i, j);
    }
  }
}

void Progress::Skip(std::uint32_t ticks) {
  for (Track& track : tracks_) track.progress = After(track.progress, ticks);
}

std::span<const std::uint32_t> Progress::Observe(Tick tick, double time_s, bool red,
                                                 std::span<const Observed> vehicles) {
  wedged_.clear();
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    Track& track = tracks_[i];
    const Observed& now = vehicles[i];
    if (!IsInCrowd(now)) track.under_way = false;
    const bool moves_on = !IsInCrowd(now) || MakesProgress(now, &track);
    track.excused = IsExcused(now, time_s, red);
    if (moves_on || track.excused) track.progress = tick;
    if (track.progress == tick) track.reported = false;
  }
  if (Number(tick) % second_ticks_ != 0) return wedged_;
  FindCrowds(vehicles);
  for (std::uint32_t i = 0; i < vehicles.size(); ++i) {
    Track& track = tracks_[i];
    // Passed on, so that a vehicle left behind by a crowd has its time.
    track.progress = std::max(track.progress, crowd_progress_[CrowdOf(i)]);
    const bool late = TicksBetween(track.progress, tick) > limit_ticks_;
    const bool wants = track.goal.set || track.route.count > 0;
    if (late && wants && !track.reported) wedged_.push_back(i);
    track.reported = late;
  }
  return wedged_;
}

}  // namespace giveway::sim
