// Reads echoes as objects: which are the bodies of known peers, which lie in the own path, which
// move by themselves. An object becomes an obstacle only by its place and its motion.
#pragma once

#include <cstdint>
#include <optional>

#include "services/vehicle/situation.h"

namespace giveway {

// Bit i is set if the echo of sensor i is where a disc centred there would echo.
std::uint32_t EchoesOf(Vec2 centre_world, double radius_m, const Situation& s);

// How far the own shell may still go before it touches what sensor `sensor` hears, if that can be
// in the swept path; a known peer's body counts by its place, anything else anywhere on the arc of
// the cone. Empty if it cannot be in the path.
std::optional<double> FreeAhead(std::size_t sensor, const Situation& s);

// True if the sensor hears something that comes nearer than the own motion explains.
bool MovesByItself(std::size_t sensor, const Situation& s);

}  // namespace giveway
