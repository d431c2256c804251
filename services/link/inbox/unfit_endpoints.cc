#include "services/link/inbox/unfit_endpoints.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace giveway::link {
namespace {

constexpr Nanoseconds kSettles = std::chrono::seconds(1);
// Checked endpoints that are remembered as other endpoints of their participant: those of a dozen
// vehicles, for a participant's endpoints are discovered close together. Some 300 bytes each.
constexpr std::size_t kMostChecked = 128;

// "a reader of fleet/beacon in v5 (Eclipse Cyclone DDS, participant 0110...)".
std::string Describe(const FoundEndpoint& endpoint) {
  return std::string(endpoint.writes ? "a writer of " : "a reader of ") + endpoint.topic +
         (HasPartition(endpoint) ? " in " : " with ") + PartitionText(endpoint) + " (" +
         VendorOf(endpoint.guid) + ", participant " + ParticipantText(endpoint.guid) + ')';
}

bool AreCounterparts(const FoundEndpoint& a, const FoundEndpoint& b) {
  return a.topic == b.topic && a.writes != b.writes;
}

bool SpeaksInAPartitionToo(const FoundEndpoint& other, const std::deque<FoundEndpoint>& known) {
  return std::ranges::any_of(known, [&](const FoundEndpoint& one) {
    return one.topic == other.topic && one.writes == other.writes && HasPartition(one) &&
           AreOfOneParticipant(one, other);
  });
}

}  // namespace

std::string WhyUnfit(const FoundEndpoint& other, const std::vector<FoundEndpoint>& own,
                     const std::deque<FoundEndpoint>& known) {
  std::string why;
  for (const FoundEndpoint& ours : own) {
    if (!AreCounterparts(other, ours)) continue;
    if (PartitionsMatch(other, ours)) {
      const std::string misfit = other.writes ? Misfit(other, ours) : Misfit(ours, other);
      if (misfit.empty()) return {};
      why = misfit;
    } else if (why.empty() && !HasPartition(other) && !SpeaksInAPartitionToo(other, known)) {
      why = "ours is in " + PartitionText(ours) + ", and no status of DDS reports a partition";
    }
  }
  return why.empty() ? why : Describe(other) + " does not match: " + why;
}

void UnfitEndpoints::Add(FoundEndpoint found, SteadyTime now) {
  found_.push_back(std::move(found));
  due_.push_back(now + kSettles);
}

bool UnfitEndpoints::IsDue(SteadyTime now) const { return !due_.empty() && due_.front() <= now; }

std::vector<std::string> UnfitEndpoints::Check(const std::vector<FoundEndpoint>& own,
                                               SteadyTime now) {
  std::vector<std::string> lines;
  for (; IsDue(now); due_.pop_front(), ++checked_) {
    const FoundEndpoint& other = found_[checked_];
    std::string why = WhyUnfit(other, own, found_);
    if (!why.empty()) lines.push_back(std::move(why));
  }
  for (; checked_ > kMostChecked; --checked_) found_.pop_front();
  return lines;
}

}  // namespace giveway::link
