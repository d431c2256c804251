// What a decision stood on: services/types/decision_evidence.h. Read after deciding.
#pragma once

#include "services/types/decision.h"
#include "services/types/decision_evidence.h"
#include "services/vehicle/situation/situation.h"

namespace giveway {

// `is_new`: the decision is another one than a step before.
DecisionEvidence EvidenceOf(const Situation& s, const Decision& decision, bool is_new);

}  // namespace giveway
