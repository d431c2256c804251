// The result of a search, computed from its evidence. Pure: reports only print it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/tune/tune_evidence.h"
#include "services/fleetctl/tune/tune_plan.h"
#include "services/fleetctl/tune/tune_predict.h"

namespace giveway::fleetctl {

struct TunedCandidate {
  TuneCandidate candidate;
  std::optional<TuneFigures> figures;  // nullopt if it was not measured: see `trouble`
  std::optional<Prediction> predicted;
  std::string disagreement;  // empty if prediction and measurement agree
  std::string trouble;
  bool on_front = false;
};

// Base and recommended measured again in parallel, with other seeds.
struct Verification {
  TuneFigures base;
  TuneFigures recommended;
  bool fewer_alarms = false;
  bool no_later = false;
};

struct TuneResult {
  std::string base_file;
  std::string impair;
  TuneFleet fleet;
  std::uint32_t seed = 0;
  double alive_s = 0;
  std::vector<TunedCandidate> candidates;  // the base first
  std::vector<std::size_t> front;          // places, by rising detection time
  std::size_t recommended = 0;             // 0: the base
  std::optional<Verification> verified;
  std::vector<TrialEvidence> trials;

  bool IsBetter() const { return verified && verified->fewer_alarms && verified->no_later; }
};

// Fills in front and recommended from the figures.
void ChooseRecommended(TuneResult* result);

}  // namespace giveway::fleetctl
