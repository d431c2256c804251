// Layouts with lanes: roundabout, corridor, door, one_lane, merge. A vehicle that has passed
// through parks in a bay next to the lane, at a random place: no vehicle has to overtake, and the
// order of arrival does not matter.
#include <algorithm>
#include <array>
#include <vector>

#include "services/types/math/math.h"
#include "sim_world/virtual/layout.h"

namespace giveway::sim {
namespace {

constexpr double kQueue_m = 2.5;      // between vehicles of one lane
constexpr double kMoved_m = 0.2;      // a start is moved along its lane by up to this
constexpr double kTwoBodies_m = 1.5;  // two Pioneers and half a metre

Vec2 Direction(double angle_rad) { return {Cos(angle_rad), Sin(angle_rad)}; }
Vec2 Right(Vec2 along) { return -1 * Left(along); }

// A passage along the x axis, centred on the origin; its lanes are lane_m off the axis.
struct Passage {
  double half_m = 0;  // of its length
  double lane_m = 0;
};

// Vehicles from both ends through the passage: they wait in two rows on their right before it, and
// park on both sides of a lane beyond it, on their right again.
void SendThrough(const Passage& passage, std::uint32_t vehicles, Layout* layout) {
  constexpr double kRow_m = 1.1;       // of the first waiting row, from the middle
  constexpr double kExitLane_m = 3.4;  // between the two rows of bays
  const auto [half_m, lane_m] = passage;
  const std::uint32_t each = (vehicles + 1) / 2;
  const std::array bays = {Shuffled(each, &layout->Dice()), Shuffled(each, &layout->Dice())};
  for (std::uint32_t i = 0; i < vehicles; ++i) {
    const double sign = i % 2 == 0 ? 1 : -1;  // eastbound on the south side, else turned by half
    const auto turned = [&](double x, double y) { return Vec2{sign * x, sign * y}; };
    const std::uint32_t place = i / 2;
    const double start_m =
        half_m + 3 + kQueue_m * (place / 2) + layout->Dice().Uniform(-kMoved_m, kMoved_m);
    const double row_m = kRow_m + (place % 2) * kBay_m;
    const std::uint32_t bay = bays[i % 2][place];
    const double bay_m = half_m + 4 + kBay_m * (bay / 2);
    const double side_m = bay % 2 == 0 ? kBeside_m : -kBeside_m;
    const std::array route = {turned(-half_m - 0.8, -lane_m), turned(half_m + 0.8, -lane_m),
                              turned(half_m + 2.5, -kExitLane_m), turned(bay_m, -kExitLane_m)};
    layout->Add(turned(-start_m, -row_m), route, turned(bay_m, -kExitLane_m - side_m));
  }
}

// The buildings on both sides of the passage, too deep for any vehicle to plan a detour.
void AddBuildings(const Passage& passage, double width_m, Layout* layout) {
  constexpr double kDepth_m = 12;
  layout->AddBlock({-passage.half_m, width_m / 2}, {passage.half_m, width_m / 2 + kDepth_m});
  layout->AddBlock({-passage.half_m, -width_m / 2 - kDepth_m}, {passage.half_m, -width_m / 2});
}

// The passage as the vehicles' map has it, up to where one who leaves turns off.
void AddOneLane(const Passage& passage, double width_m, Layout* layout) {
  constexpr double kMouth_m = 1.6;
  const double end_m = passage.half_m + kMouth_m;
  layout->AddOneLane({{-end_m, 0}, {end_m, 0}, width_m});
}

}  // namespace

// Four roads, each with a lane in and a lane out, meet in a ring of 3 to 4 m radius driven
// counter-clockwise. A vehicle joins the ring from its lane, follows it past up to two exits, and
// leaves by the first, second or third road after its own; beyond the exit it parks in a bay on its
// right.
Scenario MakeRoundabout(const Size& size) {
  Layout layout("roundabout", size);
  constexpr double kLane_m = 1.0;
  constexpr double kStep_rad = 35 * kPi / 180;  // at most, between two waypoints of the ring
  const double ring_m = layout.Dice().Uniform(3, 4);
  const double beside_rad = Atan2(kLane_m, ring_m);  // from a road's middle to its lane's mouth
  std::array<std::uint32_t, 4> parked{};
  for (std::uint32_t i = 0; i < size.vehicles; ++i) {
    const std::uint32_t from = i % 4;
    const std::uint32_t roads_on = 1 + static_cast<std::uint32_t>(layout.Dice().Next() % 3);
    const std::uint32_t to = (from + roads_on) % 4;
    const Vec2 out = Direction(kPi / 2 * from);
    const double start_m =
        ring_m + 3 + kQueue_m * (i / 4) + layout.Dice().Uniform(-kMoved_m, kMoved_m);
    const double first_rad = kPi / 2 * from + beside_rad;
    const double arc_rad = kPi / 2 * roads_on - 2 * beside_rad;
    const auto steps = static_cast<std::uint32_t>(arc_rad / kStep_rad) + 1;
    std::vector<Vec2> route;
    for (std::uint32_t step = 0; step <= steps; ++step) {
      route.push_back(ring_m * Direction(first_rad + arc_rad * step / steps));
    }
    const Vec2 away = Direction(kPi / 2 * to);
    const double bay_m = ring_m + 4 + kBay_m * parked[to]++;
    route.push_back(bay_m * away + kLane_m * Right(away));
    layout.Add(start_m * out + kLane_m * Left(out), route,
               bay_m * away + (kLane_m + kBeside_m) * Right(away));
  }
  return layout.Take();
}

// A passage of 8 to 14 m between two walls, two bodies and 0.5 to 1.5 m wide: enough for two to
// pass each other. Vehicles wait in two rows on their right at either end; behind the other end
// they park on both sides of a lane, on their right again, so that the two streams meet only in the
// passage.
Scenario MakeCorridor(const Size& size) {
  Layout layout("corridor", size);
  constexpr double kBody_m = 0.5;
  const double half_m = layout.Dice().Uniform(4, 7);
  const double width_m = 2 * kBody_m + layout.Dice().Uniform(0.5, 1.5);
  // The same gap to the wall and between two that meet.
  const double lane_m = kBody_m / 2 + (width_m - 2 * kBody_m) / 6;
  layout.AddWall({-half_m, width_m / 2}, {half_m, width_m / 2});
  layout.AddWall({-half_m, -width_m / 2}, {half_m, -width_m / 2});
  SendThrough({.half_m = half_m, .lane_m = lane_m}, size.vehicles, &layout);
  return layout.Take(2 * half_m);
}

// The wall is 0.2 m thick. A door narrower than two bodies and half a metre is passed one by one,
// through its middle.
Scenario MakeDoor(const Size& size) {
  Layout layout("door", size);
  constexpr double kHalf_m = 0.1;
  const double width_m = layout.Dice().Uniform(0.9, 1.8);
  const double lane_m = width_m < kTwoBodies_m ? 0 : 0.25 + (width_m - 1) / 6;
  AddBuildings({.half_m = kHalf_m, .lane_m = lane_m}, width_m, &layout);
  SendThrough({.half_m = kHalf_m, .lane_m = lane_m}, size.vehicles, &layout);
  if (lane_m == 0) AddOneLane({.half_m = kHalf_m}, width_m, &layout);
  return layout.Take(kMouths_m);
}

// 6 to 12 m between two buildings: once in, a vehicle can only go through, or back.
Scenario MakeOneLane(const Size& size) {
  Layout layout("one_lane", size);
  const double half_m = layout.Dice().Uniform(3, 6);
  const double width_m = layout.Dice().Uniform(0.9, 1.1);
  AddBuildings({.half_m = half_m}, width_m, &layout);
  SendThrough({.half_m = half_m}, size.vehicles, &layout);
  AddOneLane({.half_m = half_m}, width_m, &layout);
  return layout.Take(2 * half_m + kMouths_m);
}

// A ramp comes in from the left at 30 degrees; from the origin on there is one lane, with bays on
// its right.
Scenario MakeMerge(const Size& size) {
  Layout layout("merge", size);
  constexpr double kBefore_m = 4.6;
  const std::array<Vec2, 2> along = {Vec2{1, 0}, Direction(Radians(-30))};
  const std::vector<std::uint32_t> bays = Shuffled(size.vehicles, &layout.Dice());
  for (std::uint32_t i = 0; i < size.vehicles; ++i) {
    const double start_m =
        kBefore_m + kQueue_m * (i / 2) + layout.Dice().Uniform(-kMoved_m, kMoved_m);
    const double bay_m = 4 + kBay_m * bays[i];
    const std::array route = {Vec2{0, 0}, Vec2{1.5, 0}, Vec2{bay_m, 0}};
    layout.Add(-start_m * along[i % 2], route, {bay_m, -kBeside_m});
  }
  return layout.Take();
}

}  // namespace giveway::sim
