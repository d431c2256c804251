#include "services/link/inbox/arrival_log.h"

#include <algorithm>

namespace giveway::link {

void ArrivalLog::Note(std::uint64_t writer, std::uint64_t sequence, bool passed) {
  const std::scoped_lock lock(mutex_);
  const auto [found, is_new] = writers_.try_emplace(writer);
  Writer& entry = found->second;
  if (is_new) oldest_.push_back(writer);
  BeaconArrival& newest = entry.newest;
  if (sequence <= newest.sequence) return;
  if (!is_new) newest.missing += static_cast<std::uint32_t>(sequence - newest.sequence - 1);
  newest.sequence = sequence;
  ++newest.arrived;
  if (!passed) ++newest.filtered;
  entry.kept[entry.next] = newest;
  entry.next = (entry.next + 1) % kKept;
  for (; oldest_.size() > kMostWriters; oldest_.pop_front()) writers_.erase(oldest_.front());
}

std::optional<BeaconArrival> ArrivalLog::At(std::uint64_t writer, std::uint64_t sequence) {
  const std::scoped_lock lock(mutex_);
  const auto found = writers_.find(writer);
  if (found == writers_.end()) return std::nullopt;
  const auto& kept = found->second.kept;
  const auto at = std::ranges::find(kept, sequence, &BeaconArrival::sequence);
  if (at == kept.end() || sequence == 0) return std::nullopt;
  return *at;
}

void ArrivalLog::NoteLeft(std::span<const std::uint64_t> writers) {
  const std::scoped_lock lock(mutex_);
  ++turn_;
  for (const std::uint64_t writer : writers) {
    const auto found = writers_.find(writer);
    if (found != writers_.end()) left_.push_back({writer, turn_, found->second.newest.arrived});
  }
  for (; !left_.empty() && turn_ - left_.front().turn >= kTurnsToForget; left_.pop_front()) {
    Forget(left_.front());
  }
}

void ArrivalLog::Forget(const Left& left) {
  const auto found = writers_.find(left.writer);
  if (found == writers_.end() || found->second.newest.arrived != left.arrived) return;
  writers_.erase(found);
  std::erase(oldest_, left.writer);
}

}  // namespace giveway::link
