// A search in progress: which trials are still to be run, running them in parallel, and estimating
// the remaining time. The result is evidence, by candidate.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/tune/tune_plan.h"
#include "services/fleetctl/tune/tune_store.h"
#include "services/fleetctl/tune/tune_trial.h"

namespace giveway::fleetctl {

// Ctrl-C. Results so far are kept.
class TuneInterrupted : public std::exception {};

class TuneSearch {
 public:
  // `trials_planned` is only for the remaining time.
  TuneSearch(const TuneGround& ground, const TuneStore& store, std::size_t fleets,
             std::uint32_t seed, std::size_t trials_planned);

  // Measures until each candidate has that many trials, including earlier ones. Throws
  // TuneInterrupted.
  void Measure(const std::vector<TuneCandidate>& candidates, bool verification,
               std::uint32_t trials);
  std::vector<TrialEvidence> TrialsOf(const std::string& candidate, bool verification) const;
  // All of them, in the order of candidate and number.
  std::vector<TrialEvidence> All() const;
  std::size_t Measured() const { return measured_; }  // by this process

 private:
  struct Key {
    bool verification;
    std::string candidate;
    std::uint32_t trial;
    friend auto operator<=>(const Key&, const Key&) = default;
  };

  void StartNext();
  void TakeFinished();
  // The reason if the trial must be repeated.
  bool MayRepeat(const Key& key, const TrialEvidence& evidence);
  void ReportProgress(SteadyTime now);

  const TuneGround& ground_;
  const TuneStore& store_;
  std::size_t fleets_;
  std::uint32_t seed_;
  std::size_t planned_;
  std::map<Key, TrialEvidence> evidence_;
  std::deque<TrialOrder> waiting_;
  std::vector<std::unique_ptr<TuneTrial>> running_;
  std::map<Key, int> repeats_;
  std::size_t repeats_left_;
  std::size_t measured_ = 0;
  SteadyTime begun_{0};
  SteadyTime next_progress_{0};
};

}  // namespace giveway::fleetctl
