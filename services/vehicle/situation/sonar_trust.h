// Whether the own ultrasonics work, by what they say from scan to scan and by what the peers say.
// One that does not hear its peers by radio relies on them: without either it must not drive.
// Whether the peers are right stands in situation/echo_trust.h.
#pragma once

#include <cstdint>
#include <span>

#include "services/vehicle/estimation/scan_change.h"
#include "services/vehicle/situation/situation.h"

namespace giveway {

// What speaks against the own ultrasonics.
struct SonarDoubt {
  ScanNews shown_by = ScanNews::kNone;
  std::uint32_t ticks = 0;  // that showed it, less those that showed something else
};

// Of a cooperative vehicle. Ultrasonics that do not work show in scans that are
//   all clear  where a peer must be heard; at once if an echo was there a tick before
//   the same   to the last bit while the vehicle turns, or drives with an echo ahead
//   leaps      of most transducers, tick by tick, while it does not turn
// until some ticks show something else. Of ultrasonics that may miss what is there only the second
// is evidence. Reads what JudgeEchoes has found.
void JudgeSonar(std::span<const PeerView> views, const OwnView& s, SonarDoubt* doubt);

// A peer that fell silent near a vehicle whose ultrasonics do not work, until it speaks again or is
// forgotten. Null where there is none.
const PeerView* FindUnheard(std::span<const PeerView> views, const OwnView& s,
                            const SonarDoubt& doubt);

}  // namespace giveway
