// One-lane sections of the map (services/types/one_lane.h): those that the own path leads through,
// and the peers that come towards this vehicle there. The paths of such a pair are in conflict from
// end to end of the section, so that right of way decides it outside: encounter.h. Those that drive
// through it in the same direction follow each other as anywhere.
#pragma once

#include <optional>
#include <span>

#include "services/vehicle/situation/situation.h"

namespace giveway {

// The section that a point lies in; null if there is none.
const OneLane* FindOneLane(Vec2 point_world, std::span<const OneLane> lanes);

// The nearest sections that the course leads into, up to its next waypoint. None for a vehicle that
// stays where it is, nor for the lecture's behaviours, which know no map.
LanesAhead FindLanesAhead(const OwnPose& pose, const OwnCourse& course,
                          const VehicleOptions& options);

// The conflict with a peer whose path leads, in the other direction, into a section that the own
// path leads into; that in the nearest section.
std::optional<Conflict> FindOneLaneConflict(const CarriedPeer& view, const OwnView& s);

// How long at least the section of that conflict will be occupied by one that drives through it in
// the own direction, s; 0 where none is in.
double SecondsOccupied(const Conflict& conflict, std::span<const PeerView> peers, const OwnView& s);

// False if there is no such conflict with the sender, who drove up to moved_m since its beacon.
bool MayMeetInOneLane(const Beacon& beacon, double moved_m, const OwnView& s);

}  // namespace giveway
