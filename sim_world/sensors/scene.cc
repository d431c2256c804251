#include "sim_world/sensors/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace giveway::sim {
namespace {

// Cells for what moves: about the distance between vehicles in a dense fleet.
constexpr double kSceneCell_m = 1.5;
// Entries after the last disc; see SceneDiscs.
constexpr std::size_t kBehind = 3;

}  // namespace

bool SceneBox::Holds(Vec2 point_world) const {
  const Vec2 offset = point_world - centre_world;
  return std::abs(Dot(x_axis_world, offset)) <= half_m.x &&
         std::abs(Cross(x_axis_world, offset)) <= half_m.y;
}

Scene::Scene(std::span<const Wall> walls)
    : wall_grid_(walls), listed_walls_(walls, kListedReach_m), corners_(walls) {
  walls_.reserve(walls.size());
  for (const Wall& wall : walls) walls_.push_back({wall.from_world, wall.to_world, kNoOwner});
  Index();
}

void Scene::Clear() {
  disc_centres_.clear();
  disc_radii_m_.clear();
  disc_owners_.clear();
  largest_radius_m_ = 0;
  box_centres_.clear();
  boxes_.clear();
  largest_half_diagonal_m_ = 0;
  leaf_middles_.clear();
  leaves_.clear();
  longest_half_leaf_m_ = 0;
}

void Scene::AddDisc(Vec2 centre_world, double radius_m, Owner owner) {
  disc_centres_.push_back(centre_world);
  disc_radii_m_.push_back(radius_m);
  disc_owners_.push_back(owner);
  largest_radius_m_ = std::max(largest_radius_m_, radius_m);
}

void Scene::AddBox(const Pose& world_from_box, Vec2 half_m, Owner owner) {
  SceneBox box{.centre_world = world_from_box.position_world,
               .x_axis_world = Forward(world_from_box),
               .half_m = half_m,
               .owner = owner};
  const Vec2 length = half_m.x * box.x_axis_world;
  const Vec2 width = half_m.y * Left(box.x_axis_world);
  const Vec2 centre = box.centre_world;
  box.corners_world = {centre + length - width, centre + length + width, centre - length + width,
                       centre - length - width};
  box_centres_.push_back(centre);
  boxes_.push_back(box);
  largest_half_diagonal_m_ = std::max(largest_half_diagonal_m_, Norm(half_m));
}

void Scene::AddSegment(Vec2 from_world, Vec2 to_world, Owner owner) {
  leaf_middles_.push_back(0.5 * (from_world + to_world));
  leaves_.push_back({from_world, to_world, owner});
  longest_half_leaf_m_ = std::max(longest_half_leaf_m_, 0.5 * Norm(to_world - from_world));
}

void Scene::Index() {
  disc_grid_.Rebuild(disc_centres_, kSceneCell_m);
  box_grid_.Rebuild(box_centres_, kSceneCell_m);
  leaf_grid_.Rebuild(leaf_middles_, kSceneCell_m);
  const std::span<const std::uint32_t> order = disc_grid_.Order();
  sorted_x_.resize(order.size() + kBehind);
  sorted_y_.resize(order.size() + kBehind);
  sorted_radius_m_.resize(order.size() + kBehind);
  sorted_owner_.resize(order.size() + kBehind);
  for (std::size_t i = order.size(); i < sorted_x_.size(); ++i) {
    sorted_x_[i] = std::numeric_limits<double>::infinity();
    sorted_radius_m_[i] = 0;
  }
  for (std::size_t i = 0; i < order.size(); ++i) {
    sorted_x_[i] = disc_centres_[order[i]].x;
    sorted_y_[i] = disc_centres_[order[i]].y;
    sorted_radius_m_[i] = disc_radii_m_[order[i]];
    sorted_owner_[i] = disc_owners_[order[i]];
  }
}

SceneDiscs Scene::Discs() const {
  const std::size_t count = sorted_x_.size() - kBehind;
  return {.x_world = std::span(sorted_x_).first(count),
          .y_world = std::span(sorted_y_).first(count),
          .radius_m = std::span(sorted_radius_m_).first(count),
          .owner = std::span(sorted_owner_).first(count)};
}

Owner Scene::BoxAround(Vec2 point_world, Owner self) const {
  Owner around = kNoOwner;
  BoxesNear(point_world, 0, [&](const SceneBox& box) {
    // Of several the lowest number, so that the order of adding has no effect.
    if (box.owner != self && box.Holds(point_world)) around = std::min(around, box.owner);
  });
  return around;
}

}  // namespace giveway::sim
