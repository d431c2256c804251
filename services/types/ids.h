// Strong ids: a vehicle id can never be passed where a tick is meant.
#pragma once

#include <cstdint>

namespace giveway {

// Names one vehicle. 0 is none; the world never assigns it.
enum class VehicleId : std::uint32_t {};
inline constexpr VehicleId kNoVehicle{0};

// Counts the world's steps since the world's epoch started. 0 is "no tick".
enum class Tick : std::uint32_t {};
inline constexpr Tick kNoTick{0};

// Names one life of the world: a world that starts again from the start poses takes a new epoch.
// 0 is "no world heard yet".
enum class WorldEpoch : std::uint32_t {};
inline constexpr WorldEpoch kNoEpoch{0};

constexpr std::uint32_t Number(VehicleId id) { return static_cast<std::uint32_t>(id); }
constexpr std::uint32_t Number(Tick tick) { return static_cast<std::uint32_t>(tick); }
constexpr std::uint32_t Number(WorldEpoch epoch) { return static_cast<std::uint32_t>(epoch); }

// The tick `steps` after `tick`.
constexpr Tick After(Tick tick, std::uint32_t steps) { return Tick{Number(tick) + steps}; }

// Ticks from `earlier` to `later`; 0 if `later` is not after `earlier`.
constexpr std::uint32_t TicksBetween(Tick earlier, Tick later) {
  return Number(later) > Number(earlier) ? Number(later) - Number(earlier) : 0;
}

}  // namespace giveway
