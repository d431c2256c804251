#include "services/link/reader_events.h"

#include <algorithm>
#include <utility>

#include "services/link/writer_names.h"

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

std::span<const ReaderEvent> ReaderEvents::Take() {
  const std::scoped_lock lock(mutex_);
  std::copy_n(queue_.begin(), size_, taken_.begin());
  return {taken_.data(), std::exchange(size_, 0)};
}

std::uint32_t ReaderEvents::Dropped() const {
  const std::scoped_lock lock(mutex_);
  return dropped_;
}

void ReaderEvents::Push(ReaderEvent::Kind kind, const dds::InstanceHandle_t& handle) {
  const std::scoped_lock lock(mutex_);
  if (size_ == kCapacity) {
    ++dropped_;
    return;
  }
  queue_[size_++] = {kind, handle};
}

void ReaderEvents::on_requested_deadline_missed(dds::DataReader*,
                                                const dds::RequestedDeadlineMissedStatus& status) {
  Push(ReaderEvent::Kind::kDeadlineMissed, status.last_instance_handle);
}

void ReaderEvents::on_liveliness_changed(dds::DataReader*,
                                         const dds::LivelinessChangedStatus& status) {
  // A writer that leaves lowers a count; that is told by kUnmatched.
  if (status.not_alive_count_change > 0) {
    Push(ReaderEvent::Kind::kNotAlive, status.last_publication_handle);
  } else if (status.alive_count_change > 0) {
    Push(ReaderEvent::Kind::kAlive, status.last_publication_handle);
  }
}

void ReaderEvents::on_subscription_matched(dds::DataReader*,
                                           const dds::SubscriptionMatchedStatus& status) {
  const bool matched = status.current_count_change > 0;
  Push(matched ? ReaderEvent::Kind::kMatched : ReaderEvent::Kind::kUnmatched,
       status.last_publication_handle);
}

void ReaderEvents::on_requested_incompatible_qos(dds::DataReader*,
                                                 const dds::RequestedIncompatibleQosStatus&) {
  Push(ReaderEvent::Kind::kIncompatibleQos, WriterNames::FoundByThisThread());
}

}  // namespace giveway::link
