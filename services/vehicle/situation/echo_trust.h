// Graded trust, second half: what near peers say, held against what the own ultrasonics hear. What
// doubt means stands in estimation/trust.h.
#pragma once

#include <span>

#include "services/types/counters.h"
#include "services/vehicle/situation/situation.h"

namespace giveway {

// What the near peers say against what the ultrasonics hear. `someone_lost`: of all peers.
void JudgeEchoes(std::span<const PeerView> views, bool someone_lost, const OwnView& s,
                 TrustCounters* counters);

// A peer that fell silent near a cooperative vehicle whose ultrasonics show meanwhile that they do
// not work, for a vehicle that hears neither its peers nor their echoes must not drive. That shows
//   all clear  where it must be heard; at once if an echo as near was there a tick before
//   the same   to the last bit while the vehicle turns, or drives with an echo ahead
//   leaps      of most transducers, tick by tick, while it does not turn
// until some ticks show something else, the peer speaks again or is forgotten. Of ultrasonics that
// may miss what is there only the second is evidence. Null where there is none.
const PeerView* FindUnheard(const PeersNow& near);

}  // namespace giveway
