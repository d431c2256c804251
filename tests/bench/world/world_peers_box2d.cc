// Box2D 2.4: a kinematic body with a circle for every vehicle, one static body with a two-sided
// edge for every wall, a closest-hit callback for every ray. Kinematic bodies make no contacts
// among themselves, so its step is motion and the update of its tree alone.
#include <box2d/box2d.h>

#include <cmath>
#include <vector>

#include "services/types/time.h"
#include "tests/bench/world/world_peers.h"

namespace giveway::bench {
namespace {

b2Vec2 ToBox2d(Vec2 point) { return {static_cast<float>(point.x), static_cast<float>(point.y)}; }

// Keeps the nearest hit of a ray on anything but one's own body.
class NearestHit final : public b2RayCastCallback {
 public:
  explicit NearestHit(const b2Body* own) : own_(own) {}

  float ReportFixture(b2Fixture* fixture, const b2Vec2&, const b2Vec2&, float share) override {
    constexpr float kIgnore = -1;
    if (fixture->GetBody() == own_) return kIgnore;
    share_ = share;
    return share;  // the ray ends here from now on
  }
  // Of the ray's length; more than 1 if it hit nothing.
  float Share() const { return share_; }

 private:
  const b2Body* own_;
  float share_ = 2;
};

class Box2dPeer final : public Peer {
 public:
  explicit Box2dPeer(const Scenario& scenario)
      : dt_s_(static_cast<float>(Seconds(scenario.tick_period))),
        fan_(FanOf(scenario.vehicles.front().profile)),
        world_(b2Vec2(0, 0)) {
    for (const VehicleOptions& options : scenario.vehicles) AddDisc(options);
    b2BodyDef definition;
    b2Body* ground = world_.CreateBody(&definition);
    for (const Wall& wall : scenario.walls) {
      b2EdgeShape edge;
      edge.SetTwoSided(ToBox2d(wall.from_world), ToBox2d(wall.to_world));
      ground->CreateFixture(&edge, 0);
    }
    ranges_.resize(bodies_.size());
  }

  void Move(std::span<const Pose> world_from_body) override {
    poses_.assign(world_from_body.begin(), world_from_body.end());
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const b2Vec2 displacement = ToBox2d(poses_[i].position_world) - bodies_[i]->GetPosition();
      bodies_[i]->SetLinearVelocity((1 / dt_s_) * displacement);
    }
    // No constraint is to be solved, so one iteration of each kind is enough.
    world_.Step(dt_s_, 1, 1);
  }

  void Sense() override {
    for (std::size_t i = 0; i < bodies_.size(); ++i) Sense(i);
  }

  std::span<const RayRanges> Ranges() const override { return ranges_; }

 private:
  void AddDisc(const VehicleOptions& options) {
    b2BodyDef definition;
    definition.type = b2_kinematicBody;
    definition.position = ToBox2d(options.start_world.position_world);
    bodies_.push_back(world_.CreateBody(&definition));
    b2CircleShape circle;
    circle.m_radius = static_cast<float>(options.profile.body_radius_m);
    bodies_.back()->CreateFixture(&circle, 0);
  }

  void Sense(std::size_t vehicle) {
    const auto heading_rad = static_cast<float>(poses_[vehicle].heading_rad);
    const b2Vec2 x_axis = {std::cos(heading_rad), std::sin(heading_rad)};
    const b2Vec2 y_axis = {-x_axis.y, x_axis.x};
    const b2Vec2 centre = ToBox2d(poses_[vehicle].position_world);
    ranges_[vehicle].fill(kNothingHit);
    for (std::size_t ray = 0; ray < kRaysAVehicle; ++ray) {
      const b2Vec2 from =
          centre + fan_.origin_x_body[ray] * x_axis + fan_.origin_y_body[ray] * y_axis;
      const b2Vec2 direction =
          fan_.direction_x_body[ray] * x_axis + fan_.direction_y_body[ray] * y_axis;
      NearestHit hit(bodies_[vehicle]);
      world_.RayCast(&hit, from, from + fan_.range_m * direction);
      if (hit.Share() > 1) continue;
      float& range_m = ranges_[vehicle][ray / kRaysACone];
      range_m = std::min(range_m, hit.Share() * fan_.range_m);
    }
  }

  float dt_s_;
  RayFan fan_;
  b2World world_;
  std::vector<b2Body*> bodies_;  // the world's own
  std::vector<Pose> poses_;
  std::vector<RayRanges> ranges_;
};

}  // namespace

std::unique_ptr<Peer> MakeBox2dPeer(const Scenario& scenario) {
  return std::make_unique<Box2dPeer>(scenario);
}

}  // namespace giveway::bench
