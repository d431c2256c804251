#include "services/link/inbox/world_candidates.h"

#include <algorithm>
#include <utility>

namespace giveway::link {

std::vector<WorldCandidate> WorldCandidates::Keep(WorldCandidate candidate, const Found& found) {
  std::vector<WorldCandidate> gone;
  const auto take_out = [&](std::vector<WorldCandidate>::iterator one) {
    gone.push_back(std::move(*one));
    candidates_.erase(one);
  };
  const auto same =
      std::ranges::find(candidates_, candidate.participant, &WorldCandidate::participant);
  if (same != candidates_.end()) take_out(same);
  candidates_.push_back(std::move(candidate));
  if (candidates_.size() > kMost) {
    take_out(std::ranges::min_element(
        candidates_, {}, [&](const WorldCandidate& one) { return found(one.writer); }));
  }
  return gone;
}

const WorldCandidate* WorldCandidates::Best(const Found& found) const {
  const auto best = std::ranges::max_element(
      candidates_, {}, [&](const WorldCandidate& one) { return found(one.writer); });
  return best == candidates_.end() || found(best->writer) == 0 ? nullptr : &*best;
}

void WorldCandidates::Remove(std::uint64_t participant) {
  std::erase_if(candidates_, [participant](const WorldCandidate& one) {
    return one.participant == participant;
  });
}

}  // namespace giveway::link
