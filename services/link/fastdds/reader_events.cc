#include "services/link/fastdds/reader_events.h"

#include <algorithm>
#include <utility>

#include "services/link/fastdds/writer_names.h"

namespace giveway::link {

std::uint32_t KeyOf(const dds::InstanceHandle_t& instance) {
  std::uint32_t key = 0;
  for (std::size_t i = 0; i < 4; ++i) key = key << 8U | instance.value[i];
  return key;
}

dds::StatusMask ReaderEvents::Mask() {
  return dds::StatusMask::requested_deadline_missed()
         << dds::StatusMask::liveliness_changed() << dds::StatusMask::subscription_matched()
         << dds::StatusMask::requested_incompatible_qos();
}

ReaderNews ReaderEvents::Take() {
  const std::scoped_lock lock(mutex_);
  std::copy_n(queue_.begin(), size_, taken_.begin());
  missed_.clear();
  taken_matched_.clear();
  ReaderNews news{.events = {taken_.data(), std::exchange(size_, 0)}};
  if (std::exchange(dropped_before_, dropped_) == dropped_) return news;
  for (const auto& [identity, writer] : matched_) taken_matched_.push_back(writer);
  news.incomplete = true;
  news.matched = taken_matched_;
  return news;
}

std::uint32_t ReaderEvents::Dropped() const {
  const std::scoped_lock lock(mutex_);
  return dropped_;
}

void ReaderEvents::Push(ReaderEvent::Kind kind, const dds::InstanceHandle_t& handle) {
  if (size_ == kCapacity) {
    ++dropped_;
    return;
  }
  queue_[size_++] = {kind, handle};
}

void ReaderEvents::NoteMatch(const dds::InstanceHandle_t& writer, bool matched) {
  const std::uint64_t identity = Identity(GuidOf(writer));
  if (matched) {
    matched_.insert_or_assign(identity, MatchedWriter{.handle = writer});
  } else {
    matched_.erase(identity);
  }
}

void ReaderEvents::NoteLiveliness(const dds::InstanceHandle_t& writer, bool alive) {
  const auto found = matched_.find(Identity(GuidOf(writer)));
  if (found != matched_.end()) found->second.alive = alive;
}

// With the reader's lock held, which a thread may take again. The miss is of the instance that the
// timer is set for.
void ReaderEvents::on_requested_deadline_missed(dds::DataReader* reader,
                                                const dds::RequestedDeadlineMissedStatus& status) {
  const dds::InstanceHandle_t instance = status.last_instance_handle;
  if (remove_departed_ != nullptr && reader != nullptr) remove_departed_(*reader, instance);
  const std::scoped_lock lock(mutex_);
  if (missed_.size() == kMostMisses || !missed_.insert(KeyOf(instance)).second) return;
  Push(ReaderEvent::Kind::kDeadlineMissed, instance);
}

void ReaderEvents::on_liveliness_changed(dds::DataReader*,
                                         const dds::LivelinessChangedStatus& status) {
  // A writer that leaves lowers a count; kUnmatched reports that.
  const bool lost = status.not_alive_count_change > 0;
  if (!lost && status.alive_count_change <= 0) return;
  const std::scoped_lock lock(mutex_);
  NoteLiveliness(status.last_publication_handle, !lost);
  Push(lost ? ReaderEvent::Kind::kNotAlive : ReaderEvent::Kind::kAlive,
       status.last_publication_handle);
}

void ReaderEvents::on_subscription_matched(dds::DataReader*,
                                           const dds::SubscriptionMatchedStatus& status) {
  const bool matched = status.current_count_change > 0;
  const std::scoped_lock lock(mutex_);
  NoteMatch(status.last_publication_handle, matched);
  Push(matched ? ReaderEvent::Kind::kMatched : ReaderEvent::Kind::kUnmatched,
       status.last_publication_handle);
}

void ReaderEvents::on_requested_incompatible_qos(dds::DataReader*,
                                                 const dds::RequestedIncompatibleQosStatus&) {
  const std::scoped_lock lock(mutex_);
  Push(ReaderEvent::Kind::kIncompatibleQos, WriterNames::FoundByThisThread());
}

}  // namespace giveway::link
