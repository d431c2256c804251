// The listener of a reader with many writers. Its callbacks run on the library's threads, some with
// the reader's lock held, so they only copy the status and whom it is about into a bounded queue.
// Polling the statuses instead would lose who it was when several vehicles change at once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>

#include "services/link/fastdds_version.h"

namespace giveway::link {

struct ReaderEvent {
  enum class Kind : std::uint8_t {
    kDeadlineMissed,  // handle: the instance
    kAlive,           // handle: the writer, here and below
    kNotAlive,
    kMatched,
    kUnmatched,
    // handle: the writer that this thread of the library discovered last. The library says that one
    // does not fit and not which; it looks at one the moment after it told of its discovery, on the
    // same thread, except where a reader is made or changed: then it is any other.
    kIncompatibleQos,
  };
  Kind kind = Kind::kMatched;
  dds::InstanceHandle_t handle;
};

// The key of an instance whose key is one uint32: it lies readable in the handle, big-endian in
// bytes 0 to 3.
std::uint32_t KeyOf(const dds::InstanceHandle_t& instance);

class ReaderEvents final : public dds::DataReaderListener {
 public:
  // The statuses to listen for: all of the above.
  static dds::StatusMask Mask();

  // What came since the last call, in order. Holds until the next call.
  std::span<const ReaderEvent> Take();
  // Events that found the queue full, so far.
  std::uint32_t Dropped() const;

  void on_requested_deadline_missed(dds::DataReader*,
                                    const dds::RequestedDeadlineMissedStatus& status) override;
  void on_liveliness_changed(dds::DataReader*, const dds::LivelinessChangedStatus& status) override;
  void on_subscription_matched(dds::DataReader*,
                               const dds::SubscriptionMatchedStatus& status) override;
  void on_requested_incompatible_qos(dds::DataReader*,
                                     const dds::RequestedIncompatibleQosStatus& status) override;

 private:
  // A loop of 50 ms meets at most one deadline miss a vehicle and period: enough for 256 vehicles
  // that all leave while it is a second late.
  static constexpr std::size_t kCapacity = 2048;

  void Push(ReaderEvent::Kind kind, const dds::InstanceHandle_t& handle);

  mutable std::mutex mutex_;
  std::array<ReaderEvent, kCapacity> queue_;  // guarded by mutex_, as the two below
  std::size_t size_ = 0;
  std::uint32_t dropped_ = 0;
  std::array<ReaderEvent, kCapacity> taken_;
};

}  // namespace giveway::link
