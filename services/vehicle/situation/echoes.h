// Reads echoes as objects: which are the bodies of known peers, which lie in the own path, which
// move by themselves. An object becomes an obstacle only by its place and its motion.
#pragma once

#include <cstdint>
#include <optional>

#include "services/vehicle/situation/situation.h"

namespace giveway {

// Lists what the sensors hold at `tick`.
void HearEchoes(const RangeView& ranges, Tick tick, const VehicleOptions& options,
                HeardEchoes* heard);

// What is heard or seen this near to a peer's shell is that body.
inline constexpr double kSameBody_m = 0.25;
// Of a reading's noise, in standard deviations: beyond them it is none.
inline constexpr double kNoiseSigmas = 4;

// The echoes that are where a peer's body would have echoed when the sensors fired.
struct PeerEchoes {
  std::uint32_t sensors = 0;  // bit i: of sensor i
  double nearer_m = 0;        // by how much the body is nearer than its beacon says, at the least
};
PeerEchoes EchoesOf(const CarriedPeer& peer, const OwnView& s);

// How far straight on until the own disc touches a disc at `centre_body`; empty if it passes with
// a margin to spare. `sum_of_radii` is that of both.
std::optional<double> FreeBeforeDisc(Vec2 centre_body, double sum_of_radii);

// The same of a point, for a body that is narrower by so much than its radius. Places to its side
// do not count where it is near: along a wall the vehicle may continue.
std::optional<double> FreeBeforePoint(Vec2 point_body, double body_radius_m, double narrower_m = 0);

// Left between the shell and what an echo may be of.
inline constexpr double kStandOff_m = 0.15;

// How far the own shell may still go before it touches what sensor `sensor` hears, if that can be
// in the swept path; a known peer's body counts by its place, anything else anywhere on the arc of
// the cone. Empty if it cannot be in the path.
std::optional<double> FreeAhead(std::size_t sensor, const Situation& s);
// The same in the direction it has once it has turned by turned_rad to the left.
std::optional<double> FreeOnceTurned(std::size_t sensor, double turned_rad, const Situation& s);

// How far the vehicle may still go before its shell meets the face that sensor `sensor` hears, if
// that comes nearer as it drives, or would once the vehicle has turned by turns_rad to the left. A
// face that slants into the path sends back only from where its normal meets the transducer, which
// is next to the path: where it crosses the path it is not heard. For imperfect ultrasonics; exact
// ones hear the nearest point of a cone, whatever its normal. Empty if it comes no nearer.
std::optional<double> FreeAlongFace(std::size_t sensor, double turns_rad, const Situation& s);

// True if the sensor hears something that comes nearer than the own motion explains.
bool MovesByItself(std::size_t sensor, const OwnView& s);

}  // namespace giveway
