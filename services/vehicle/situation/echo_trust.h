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

}  // namespace giveway
