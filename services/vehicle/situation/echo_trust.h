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

// A peer that fell silent, could not yet have got away from where the ultrasonics must hear it, and
// was not heard: nothing was. Ultrasonics that do not work say that all is clear, and a cooperative
// vehicle that hears neither its peers nor their echoes must not drive by that. Until they hear
// anything, the peer speaks again or is forgotten. Null where there is none, and where ultrasonics
// may miss what is there.
const PeerView* FindUnheard(const PeersNow& near);

}  // namespace giveway
