// The field every benchmark of the world drives in: one P3-DX per 4 m^2 with all 16 ultrasonics
// on, walls round it, a square pillar of 1 m for every 16 vehicles, and drivers that keep all of
// them turning, braking and bumping. The drivers see the truth; they are not brains.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/types/math/random.h"
#include "services/types/scenario.h"
#include "sim_world/world.h"

namespace giveway::bench {

// Columns and rows of cells of 2 m; each cell has one vehicle.
struct FieldSize {
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;

  std::uint32_t Vehicles() const { return columns * rows; }
};

inline constexpr FieldSize kHundred = {10, 10};
inline constexpr FieldSize kThousand = {25, 40};
inline constexpr FieldSize kTenThousand = {100, 100};

// The same size gives the same field. Its middle is the world's origin.
Scenario FieldOf(FieldSize size, SonarTier tier);

// A world with its drivers.
class BusyWorld {
 public:
  explicit BusyWorld(const Scenario& scenario);

  // Gives every vehicle its command for the next tick: a random speed and turn, drawn again every
  // second and whenever a contact stopped it.
  void Command();
  // What the benchmarks time: motion, contacts, walls and ultrasonics of one tick.
  void Advance() { world_.Advance(true); }
  // Both, untimed, until the vehicles have left their starting lattice.
  void WarmUp();

  std::span<const sim::Body> Bodies() const { return world_.Bodies(); }
  std::uint32_t Contacts() const { return world_.Contacts(); }

 private:
  sim::World world_;
  std::vector<Random> dice_;
  std::vector<WheelSpeeds> targets_;
};

}  // namespace giveway::bench
