#include "services/fleetctl/tune/tune_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "services/fleetctl/process/interrupts.h"
#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

constexpr Nanoseconds kTurn = std::chrono::milliseconds(5);  // the accuracy of kill times
constexpr Nanoseconds kProgressEvery = std::chrono::seconds(5);
constexpr int kMostRepeats = 2;  // of one trial, before its result is accepted
// Start, settling, kills and the end of a trial; only for the remaining time.
constexpr double kAroundTrialSeconds = 5;

}  // namespace

TuneSearch::TuneSearch(const TuneGround& ground, const TuneStore& store, std::size_t fleets,
                       std::uint32_t seed, std::size_t trials_planned)
    : ground_(ground),
      store_(store),
      fleets_(fleets),
      seed_(seed),
      planned_(trials_planned),
      repeats_left_(trials_planned / 5 + 1),
      begun_(SteadyNow()) {
  for (const TrialEvidence& found : store.Found()) {
    if (!found.trouble.empty()) continue;  // it is repeated
    evidence_[{found.verification, found.candidate, found.trial}] = found;
  }
}

void TuneSearch::Measure(const std::vector<TuneCandidate>& candidates, bool verification,
                         std::uint32_t trials) {
  // By trial number, so that all candidates are measured close together in time.
  for (std::uint32_t trial = 0; trial < trials; ++trial) {
    for (const TuneCandidate& candidate : candidates) {
      if (evidence_.contains({verification, candidate.name, trial})) continue;
      const std::string name =
          fmt::format("{}{}-{}", verification ? "verify-" : "", candidate.name, trial);
      waiting_.push_back({candidate.name,
                          (store_.Folder() / "profiles" / (candidate.name + ".xml")).string(),
                          verification, trial, TrialSeed(seed_, verification, trial),
                          store_.Folder() / "running" / name});
    }
  }
  while (!waiting_.empty() || !running_.empty()) {
    if (Interrupts::Count() > 0) {
      waiting_.clear();
      running_.clear();  // kills running trials
      throw TuneInterrupted();
    }
    StartNext();
    const SteadyTime now = SteadyNow();
    for (const auto& trial : running_) trial->Turn(now);
    TakeFinished();
    ReportProgress(now);
    SleepUntil(now + kTurn);
  }
}

// One at a time, so that no two fleets start at the same instant.
void TuneSearch::StartNext() {
  if (waiting_.empty() || running_.size() >= fleets_) return;
  running_.push_back(std::make_unique<TuneTrial>(ground_, waiting_.front()));
  waiting_.pop_front();
}

void TuneSearch::TakeFinished() {
  for (std::size_t i = running_.size(); i-- > 0;) {
    if (!running_[i]->IsOver()) continue;
    TrialEvidence evidence = running_[i]->TakeEvidence();
    const TrialOrder order = running_[i]->Order();
    running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
    const Key key{order.verification, order.candidate, order.trial};
    if (MayRepeat(key, evidence)) {
      waiting_.push_back(order);
      continue;
    }
    ++measured_;
    store_.Keep(evidence);
    evidence_[key] = std::move(evidence);
  }
}

// A trial that failed, or in which the machine itself paused for longer than a loop ever waits (one
// and a half ticks): its result is not due to the profile.
bool TuneSearch::MayRepeat(const Key& key, const TrialEvidence& evidence) {
  const double longest_ms = 2 * Milliseconds(ground_.scenario->tick_period);
  std::string why = evidence.trouble;
  if (why.empty() && evidence.longest_pause_ms > longest_ms) {
    why = fmt::format("the machine stood still for {:.0f} ms", evidence.longest_pause_ms);
  }
  if (why.empty()) return false;
  const bool again = repeats_left_ > 0 && repeats_[key] < kMostRepeats;
  std::fprintf(stderr, "%s, trial %u: %s%s\n", key.candidate.c_str(), key.trial, why.c_str(),
               again ? "; once more" : "");
  if (!again) return false;
  ++repeats_[key];
  --repeats_left_;
  return true;
}

void TuneSearch::ReportProgress(SteadyTime now) {
  if (now < next_progress_) return;
  next_progress_ = now + kProgressEvery;
  const std::size_t done = evidence_.size();
  const std::size_t left = std::max(planned_, done + waiting_.size() + running_.size()) - done;
  // By the duration of the trials so far; before the first is over, by the planned one.
  const double guess_s = (ground_.alive_s + kAroundTrialSeconds) / static_cast<double>(fleets_);
  const double each_s =
      measured_ < fleets_ ? guess_s : Seconds(now - begun_) / static_cast<double>(measured_);
  const double left_s = static_cast<double>(left) * each_s;
  std::string names;
  for (const auto& trial : running_) {
    names += (names.empty() ? "" : ", ") + trial->Order().candidate;
  }
  std::fprintf(stderr, "%zu of %zu trials, about %.0f:%02d min left; now %s\n", done, done + left,
               std::floor(left_s / 60), static_cast<int>(left_s) % 60, names.c_str());
}

std::vector<TrialEvidence> TuneSearch::TrialsOf(const std::string& candidate,
                                                bool verification) const {
  std::vector<TrialEvidence> trials;
  for (const auto& [key, evidence] : evidence_) {
    if (key.candidate == candidate && key.verification == verification) trials.push_back(evidence);
  }
  return trials;
}

std::vector<TrialEvidence> TuneSearch::All() const {
  std::vector<TrialEvidence> all;
  for (const auto& [key, evidence] : evidence_) all.push_back(evidence);
  return all;
}

}  // namespace giveway::fleetctl
