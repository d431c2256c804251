// Endpoints of others that are on a topic of ours and will never match: their QoS does not fit, or
// they have no partition, which DDS reports nowhere. Checked a second after they were found, when
// all of their participant's are known. Knows no DDS, has no clock.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "services/link/fastdds/found_endpoint.h"
#include "services/types/time.h"

namespace giveway::link {

// Why `other` matches none of `own`; empty if it matches one, or if it is not meant to: a reader of
// another vehicle's ranges, a fleet in another area. `known` are endpoints of others: a participant
// with writers both without a partition and in one is received in that one.
std::string WhyUnfit(const FoundEndpoint& other, const std::vector<FoundEndpoint>& own,
                     const std::deque<FoundEndpoint>& known);

class UnfitEndpoints {
 public:
  void Add(FoundEndpoint found, SteadyTime now);
  bool IsDue(SteadyTime now) const;
  // Lines for the log, one an endpoint; each endpoint is checked once.
  std::vector<std::string> Check(const std::vector<FoundEndpoint>& own, SteadyTime now);
  // Endpoints that are kept, checked or not.
  std::size_t Known() const { return found_.size(); }

 private:
  std::deque<FoundEndpoint> found_;  // those due first; then some that were checked
  std::deque<SteadyTime> due_;       // of found_, from checked_ on
  std::size_t checked_ = 0;
};

}  // namespace giveway::link
