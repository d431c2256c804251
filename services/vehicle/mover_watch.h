// Unidentified motion: something moves by itself near the vehicle, and no fresh beacon explains it.
#pragma once

#include "services/types/counters.h"
#include "services/vehicle/situation/situation.h"
#include "services/vehicle/vehicle_state.h"

namespace giveway {

// Takes in how fast the vehicle turns. True while it turns sharply or on the spot, or did just now:
// a cone that swings along a wall makes its echo come nearer faster than any of the formulas say.
bool NoteTurning(const Twist& own, Tick tick, Nanoseconds tick_period, MoverWatch* watch);

Movers DetectMovers(const OwnView& s, const PeersNow& near, MoverWatch* watch,
                    TrustCounters* counters);

}  // namespace giveway
