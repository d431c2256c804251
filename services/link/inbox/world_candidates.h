// Participants that speak as a world and are not believed, yet: the newest entry of each. Bounded:
// of too many the one goes that would be followed last. Knows no DDS, has no clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "services/types/fleet_facts.h"

namespace giveway::link {

struct WorldCandidate {
  std::uint64_t participant = 0;
  std::uint64_t writer = 0;
  RosterEntry entry;
  bool is_new = true;  // nothing was said of it yet
};

class WorldCandidates {
 public:
  static constexpr std::size_t kMost = 4;
  // When a writer was first discovered: 1, 2, 3 ...; 0 of one that has left or is not known.
  using Found = std::function<std::uint64_t(std::uint64_t writer)>;

  // Those that gave way to it: none, an older entry of the same participant, or the least likely
  // world, which may be the new one.
  std::vector<WorldCandidate> Keep(WorldCandidate candidate, const Found& found);
  // The one to be followed: of those that are there the one found last, a world that was started
  // again. Null if there is none. Valid until the next call.
  const WorldCandidate* Best(const Found& found) const;
  void Remove(std::uint64_t participant);
  std::vector<WorldCandidate>& All() { return candidates_; }

 private:
  std::vector<WorldCandidate> candidates_;  // in order of arrival
};

}  // namespace giveway::link
