// What a decision was based on, besides its reason: for figures of how late and how near, never for
// deciding.
#pragma once

#include <optional>

#include "services/types/time.h"

namespace giveway {

struct DecisionEvidence {
  // Age of the oldest beacon that was decided by, as the brain counts it (see Age in
  // services/vehicle): of the peers that matter and count as fresh. Nothing where there is none.
  std::optional<Nanoseconds> oldest_beacon;
  // Of a decision that is new: how far the own shell may go until it touches what the decision is
  // about, or is at the stop line; not negative. Nothing where the reason has no place.
  std::optional<double> free_m;
};

}  // namespace giveway
