#include "sim_world/run/reaction.h"

#include <algorithm>
#include <vector>

namespace giveway::sim {
namespace {

// The smallest sample that at least `percent` of all do not exceed. `samples` are sorted.
double NearestRank_ms(const std::vector<Nanoseconds>& samples, std::size_t percent) {
  const std::size_t rank = (samples.size() * percent + 99) / 100;
  return Milliseconds(samples[rank - 1]);
}

}  // namespace

void ReactionMeter::Published(Tick tick, SteadyTime at) {
  publications_[Number(tick) % kRememberedTicks] = {tick, at};
}

void ReactionMeter::Applied(const MotorCommand& command, SteadyTime at) {
  const Tick cause = command.decision.cause_tick;
  if (!command.decision_changed || cause == kNoTick) return;
  const Publication& publication = publications_[Number(cause) % kRememberedTicks];
  if (publication.tick != cause) return;
  const Nanoseconds sample = at - publication.at;
  samples_[count_++ % kKeptSamples] = sample;
  longest_ = std::max(longest_, sample);
}

ReactionFigures ReactionMeter::Figures() const {
  ReactionFigures figures{.count = count_, .p50_ms = {}, .p99_ms = {}, .max_ms = {}};
  if (count_ == 0) return figures;
  const auto kept = std::min<std::size_t>(count_, kKeptSamples);
  std::vector<Nanoseconds> sorted(samples_.begin(), samples_.begin() + kept);
  std::sort(sorted.begin(), sorted.end());
  figures.p50_ms = NearestRank_ms(sorted, 50);
  figures.p99_ms = NearestRank_ms(sorted, 99);
  figures.max_ms = Milliseconds(longest_);
  return figures;
}

}  // namespace giveway::sim
