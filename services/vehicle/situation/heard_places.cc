#include "services/vehicle/situation/heard_places.h"

#include <algorithm>

#include "services/types/math/math.h"
#include "services/vehicle/situation/claim.h"
#include "services/vehicle/situation/echoes.h"

namespace giveway {
namespace {

// What is heard this near to a peer's shell is the peer.
constexpr double kRoundPeer_m = 0.15;
// No cone's arc reaches a peer further away than this.
constexpr double kNearPeer_m = 3;
// A place is wider than its echo, on both sides of it: a smaller lateral margin is enough.
constexpr double kNarrower_m = 0.03;
// The middle of the body itself is surely not the place of anything else.
constexpr double kShare = 0.8;

double InnerRadius(const RobotModel& profile) {
  if (profile.shape == BodyShape::kDisc) return profile.body_radius_m;
  return std::min(profile.box_half_m.x, profile.box_half_m.y);
}

struct KnownBodies {
  std::array<KnownBody, 16> of;
  std::size_t count = 0;
};

// Peers that say where they are.
KnownBodies KnownNear(std::span<const PeerView> peers, const OwnView& s) {
  KnownBodies known;
  for (const PeerView& view : peers) {
    if (!view.believed || view.distance_m > kNearPeer_m || known.count == known.of.size()) continue;
    known.of[known.count++] = {
        InBody(s, view.position_world),
        view.peer->beacon.body_radius_m + kRoundPeer_m + kSigmas * view.sigma_m};
  }
  return known;
}

HeardCone HeardBy(std::size_t sensor, bool explained, const OwnView& s) {
  const SensorView& view = s.ranges[sensor];
  const double before_s = view.missed ? 0 : view.echo_before_s;
  const double age_s = Seconds(TicksBetween(view.tick, s.tick) * s.options.tick_period) + before_s;
  const bool echo = view.kind == Echo::kEcho && !view.missed;
  Vec2 apex = s.options.profile.sonar[sensor].position_body;
  Vec2 axis = s.cones.of[sensor].axis_body;
  if (age_s > 0) {
    const Facing then = AdvanceFacing({{0, 0}, {1, 0}}, {s.speed_m_s, s.turn_rad_s}, -age_s);
    const auto turned = [&then](Vec2 body) {
      return body.x * then.forward_world + body.y * Left(then.forward_world);
    };
    apex = then.position_world + turned(apex);
    axis = turned(axis);
  }
  return {.apex_body = apex,
          .axis_body = axis,
          .half_sine = s.cones.half_sine,
          .echo = echo,
          .range_m = view.range_m,
          .unsure_m = kSigmas * s.options.sonar_noise * view.range_m,
          .enters = !explained,
          .moves = echo && !s.turns && MovesByItself(sensor, s)};
}

}  // namespace

bool Remembers(const VehicleOptions& options) {
  return options.behaviour == Behaviour::kCooperative && HasImperfectSonar(options);
}

void RememberEchoes(const OwnView& s, const PeersNow& near, ObstacleGrid* grid) {
  if (!s.new_tick) return;
  const KnownBodies known = KnownNear(near.peers, s);
  for (const std::size_t i : BitsOf(s.cones.enabled)) {
    const SensorView& view = s.ranges[i];
    if (view.kind == Echo::kNoData || !grid->IsNew(i, view.tick)) continue;
    const bool explained = (near.explained >> i & 1U) != 0;
    grid->Hear(HeardBy(i, explained, s), {known.of.data(), known.count});
  }
  grid->StandsOn(kShare * InnerRadius(s.options.profile));
  grid->Fade(Seconds(s.options.tick_period));
}

void ListPlaces(const ObstacleGrid& grid, const OwnView& s, HeardPlaces* places) {
  // As far as one is steered past, or slows the vehicle down.
  constexpr double kRound_m = 0.6;
  const double near_m =
      s.options.profile.body_radius_m + std::max(kRound_m, s.slows_m + kStandOff_m);
  places->count = 0;
  if (!grid.IsActive()) return;
  grid.Held([&](Vec2 place_body) {
    if (SquaredNorm(place_body) > near_m * near_m) return;
    if (places->count < places->of.size()) places->of[places->count++] = place_body;
  });
}

std::optional<double> FreeOfPlaces(Vec2 direction_body, const Situation& s) {
  const double body_m = s.own.options.profile.body_radius_m;
  std::optional<double> nearest_m;
  for (const Vec2 place : s.places) {
    const Vec2 ahead = {Dot(direction_body, place), Cross(direction_body, place)};
    const auto free_m = FreeBeforePoint(ahead, body_m, kNarrower_m);
    if (free_m && (!nearest_m || *free_m < *nearest_m)) nearest_m = free_m;
  }
  return nearest_m;
}

}  // namespace giveway
