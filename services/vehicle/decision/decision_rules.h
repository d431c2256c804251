// The rules, each a pure function of the situation: it proposes a limit with its reason, or has
// nothing to say. Decide takes the most restrictive.
#pragma once

#include <optional>

#include "services/vehicle/situation/situation.h"

namespace giveway {

struct Proposal {
  double max_speed_m_s = 0;  // forward
  bool may_turn = false;     // a disc that turns on the spot touches nothing; a dead stop is dead
  Rule rule = Rule::kCruise;
  VehicleId peer = kNoVehicle;
  int sensor = -1;
  Tick cause_tick = kNoTick;  // of the scan or beacon that shows the cause
};

// Dead stops, whatever the behaviour.
std::optional<Proposal> Leaving(const Situation& s);
std::optional<Proposal> NotRunning(const Situation& s);
std::optional<Proposal> RangesStale(const Situation& s);
std::optional<Proposal> Arrived(const Situation& s);
std::optional<Proposal> Lost(const Situation& s);

// Slower, by how well it knows where it is.
std::optional<Proposal> Unsure(const Situation& s);

// Right of way: dead stops for the nearest peer that an encounter holds this vehicle for.
std::optional<Proposal> GiveWay(const Situation& s);
std::optional<Proposal> NotGranted(const Situation& s);
std::optional<Proposal> PeerLost(const Situation& s);

// Passive safety: stop before where a peer may be until it stands.
std::optional<Proposal> KeepClear(const Situation& s);

// Stop before a crossing if a vehicle stands behind it, or will, so that this vehicle would have to
// stop inside (box.h). Named kKeepClear: the cause is where a peer may be.
std::optional<Proposal> KeepBoxClear(const Situation& s);

// A red light ahead: published from a distance, so that peers know, and limits the speed so that
// the vehicle stops before its line.
std::optional<Proposal> Signal(const Situation& s);

// What radar and lidar ask for (objects_ahead.h).
std::optional<Proposal> Object(const Situation& s);

// What the own ultrasonics ask for by themselves.
std::optional<Proposal> UnidentifiedMotion(const Situation& s);
std::optional<Proposal> Obstacle(const Situation& s);

// The lowest limit proposed by the rules of the vehicle's behaviour; of equal limits the more
// informative reason names the decision. Empty if no rule proposes one.
std::optional<Proposal> MostRestrictive(const Situation& s);

// True if every rule but those for what stands still, Obstacle and Object, lets a cooperative
// vehicle keep its speed.
bool OnlyObstaclesSlow(const Situation& s);

}  // namespace giveway
