// Starts, holds and ends encounters: the memory that keeps right of way from flickering. An
// encounter starts when two paths conflict, and ends when they no longer do and the gap has opened.
#pragma once

#include "services/vehicle/situation/situation.h"

namespace giveway {

// Moves every peer's encounter on by one tick. What all of them together ask for.
Encounters UpdateEncounters(std::span<const PeerView> views, const OwnView& s);

// True if this vehicle is the one to wait in the encounter, and can: it stands, or will before
// the conflict. Only then may it say that it gives way.
bool CanGiveWay(const PeerView& view, const OwnView& s);

}  // namespace giveway
