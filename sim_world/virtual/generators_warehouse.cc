// The warehouse:
//
//   s s s G | | |  rack ..........  | | | G     s  vehicles to fetch something, waiting in rows
//   . . . . | | |  o  o  o  o  <--  | | | G     G  goals of vehicles that bring something out
//   s s s s | | |             -->   | | | G     o  vehicles that bring something out
//         G | | |  g  g  g  g       | | | G     g  goals of vehicles that fetch something
//         G | | |  rack ..........  | | | G
//
// Roads run along both sides, an aisle between any two racks; each has two lanes, and traffic keeps
// to the right. An aisle is two bodies and half a metre wide between its two strips for standing,
// so that a standing vehicle obstructs none.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "sim_world/virtual/layout.h"

namespace giveway::sim {
namespace {

constexpr double kAisleLane_m = 0.42;  // from an aisle's middle to its lanes'
constexpr double kStrip_m = 1.35;      // from an aisle's middle to vehicles that stand in it
constexpr double kRack_m = 1.9;        // from an aisle's middle to its racks
constexpr double kPitch_m = 4.8;       // from aisle to aisle
constexpr std::uint32_t kSlots = 4;
constexpr double kFirstSlot_m = 1.6;
constexpr double kAisle_m = 2 * kFirstSlot_m + (kSlots - 1) * kBay_m;
// Across the west road; the east road is its mirror image.
constexpr double kNorthbound_m = -0.9;
constexpr double kSouthbound_m = -2.1;
constexpr double kGoals_m = -3.9;
constexpr double kRows_m = -6.2;
constexpr double kEastOuter_m = kAisle_m + 2.1;  // northbound
constexpr double kEastInner_m = kAisle_m + 0.9;
constexpr double kEastGoals_m = kAisle_m + 3.9;
// Along the west road two goals and a waiting row alternate.
constexpr double kTurn_m = 3 * kBay_m;
constexpr std::uint32_t kRowDepth = 4;
constexpr double kRowQueue_m = 2.4;

struct Counts {
  std::uint32_t fetching = 0;
  std::uint32_t leaving_west = 0;
  std::uint32_t leaving_east = 0;
  std::uint32_t aisles = 0;
};

Counts CountsFor(std::uint32_t vehicles) {
  Counts counts;
  counts.leaving_east = vehicles / 4;
  counts.leaving_west = vehicles / 4;
  counts.fetching = vehicles - counts.leaving_west - counts.leaving_east;
  const double turns = std::max(std::ceil(counts.fetching / double{kRowDepth}),
                                std::ceil(counts.leaving_west / 2.0));
  const double in_aisles =
      std::max(counts.fetching, counts.leaving_west + counts.leaving_east) / double{kSlots};
  const double height_m = std::max(turns * kTurn_m, counts.leaving_east * kBay_m);
  counts.aisles = static_cast<std::uint32_t>(
      std::max({2.0, std::ceil(in_aisles), std::ceil(height_m / kPitch_m)}));
  return counts;
}

double AisleY(std::uint32_t slot) { return kPitch_m * (slot / kSlots); }
double SlotX(std::uint32_t slot) { return kFirstSlot_m + kBay_m * (slot % kSlots); }
// From south to north on the right-hand lane, or back.
double WestLane(double from_y, double to_y) {
  return to_y > from_y ? kNorthbound_m : kSouthbound_m;
}
double EastLane(double from_y, double to_y) { return to_y > from_y ? kEastOuter_m : kEastInner_m; }

void AddRacks(std::uint32_t aisles, Layout* layout) {
  for (std::uint32_t rack = 0; rack <= aisles; ++rack) {
    const double middle_y = kPitch_m * (rack - 0.5);
    const double half_m = kPitch_m / 2 - kRack_m;
    layout->AddBlock({0, middle_y - half_m}, {kAisle_m, middle_y + half_m});
  }
}

void AddFetching(std::uint32_t i, std::uint32_t slot, Layout* layout) {
  const double start_y = kTurn_m * (i / kRowDepth) + 2 * kBay_m;
  const double start_x =
      kRows_m - kRowQueue_m * (i % kRowDepth) + layout->Dice().Uniform(-0.15, 0.15);
  const double lane_y = AisleY(slot) - kAisleLane_m;
  const double road_x = WestLane(start_y, lane_y);
  const std::array route = {Vec2{road_x, start_y}, Vec2{road_x, lane_y}, Vec2{0.6, lane_y},
                            Vec2{SlotX(slot), lane_y}};
  layout->Add({start_x, start_y}, route, {SlotX(slot), AisleY(slot) - kStrip_m});
}

void AddLeavingWest(std::uint32_t goal, std::uint32_t slot, Layout* layout) {
  const double goal_y = kTurn_m * (goal / 2) + kBay_m * (goal % 2);
  const double lane_y = AisleY(slot) + kAisleLane_m;
  const double road_x = WestLane(lane_y, goal_y);
  const std::array route = {Vec2{SlotX(slot), lane_y}, Vec2{road_x, lane_y}, Vec2{road_x, goal_y}};
  layout->Add({SlotX(slot), AisleY(slot) + kStrip_m}, route, {kGoals_m, goal_y});
}

void AddLeavingEast(std::uint32_t goal, std::uint32_t slot, Layout* layout) {
  const double goal_y = kBay_m * goal;
  const double lane_y = AisleY(slot) - kAisleLane_m;
  const double road_x = EastLane(lane_y, goal_y);
  const std::array route = {Vec2{SlotX(slot), lane_y}, Vec2{road_x, lane_y}, Vec2{road_x, goal_y}};
  layout->Add({SlotX(slot), AisleY(slot) + kStrip_m}, route, {kEastGoals_m, goal_y});
}

}  // namespace

Scenario MakeWarehouse(const Size& size) {
  Layout layout("warehouse", size);
  const Counts counts = CountsFor(size.vehicles);
  AddRacks(counts.aisles, &layout);
  const auto fetched = Shuffled(counts.aisles * kSlots, &layout.Dice());
  const auto brought = Shuffled(counts.aisles * kSlots, &layout.Dice());
  const auto west = Shuffled(counts.leaving_west, &layout.Dice());
  const auto east = Shuffled(counts.leaving_east, &layout.Dice());
  for (std::uint32_t i = 0; i < counts.fetching; ++i) AddFetching(i, fetched[i], &layout);
  for (std::uint32_t i = 0; i < counts.leaving_west; ++i) {
    AddLeavingWest(west[i], brought[i], &layout);
  }
  for (std::uint32_t i = 0; i < counts.leaving_east; ++i) {
    AddLeavingEast(east[i], brought[counts.leaving_west + i], &layout);
  }
  return layout.Take();
}

}  // namespace giveway::sim
