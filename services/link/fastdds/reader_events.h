// The listener of a reader with many writers. Its callbacks run on the library's threads, some with
// the reader's lock held, so they only copy the status and its handle into a bounded queue, and
// remove departed instances while the library waits. Polling the statuses instead would lose which
// vehicle it was when several change at once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "services/link/fastdds/fastdds_version.h"

namespace giveway::link {

struct ReaderEvent {
  enum class Kind : std::uint8_t {
    kDeadlineMissed,  // handle: the instance
    kAlive,           // handle: the writer, here and below
    kNotAlive,
    kMatched,
    kUnmatched,
    // handle: the writer that this thread of the library discovered last. The library says that a
    // writer does not fit and not which; it checks one right after reporting its discovery, on the
    // same thread, except when a reader is created or changed: then it is any other.
    kIncompatibleQos,
  };
  Kind kind = Kind::kMatched;
  dds::InstanceHandle_t handle;
};

// A writer that is matched now.
struct MatchedWriter {
  dds::InstanceHandle_t handle;
  bool alive = true;  // false from its loss of liveliness until it is back
};

// What came since the last look, in order.
struct ReaderNews {
  std::span<const ReaderEvent> events;
  // Events were dropped: what is matched now is in `matched`, whatever the events say.
  bool incomplete = false;
  std::span<const MatchedWriter> matched;
};

// The key of an instance whose key is one uint32: it lies readable in the handle, big-endian in
// bytes 0 to 3.
std::uint32_t KeyOf(const dds::InstanceHandle_t& instance);

class ReaderEvents final : public dds::DataReaderListener {
 public:
  // Removes what is gone from a reader that is drained by AnchoredReader: RemoveDeparted.
  using Remover = void (*)(dds::DataReader& reader, const dds::InstanceHandle_t& kept);

  explicit ReaderEvents(Remover remove_departed = nullptr) : remove_departed_(remove_departed) {}

  // The statuses to listen for: all of the above.
  static dds::StatusMask Mask();

  // Holds until the next call. The library repeats the miss of an instance every period for as long
  // as it has it: between two calls it is reported once.
  ReaderNews Take();
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
  // Enough for 256 vehicles of which each comes, falls silent, misses a deadline and leaves between
  // two looks. Misses fill no more than half of it: a writer that claims thousands of ids crowds
  // out no match.
  static constexpr std::size_t kCapacity = 2048;
  static constexpr std::size_t kMostMisses = kCapacity / 2;

  // All three with mutex_ held.
  void Push(ReaderEvent::Kind kind, const dds::InstanceHandle_t& handle);
  void NoteMatch(const dds::InstanceHandle_t& writer, bool matched);
  void NoteLiveliness(const dds::InstanceHandle_t& writer, bool alive);

  const Remover remove_departed_;
  mutable std::mutex mutex_;
  std::array<ReaderEvent, kCapacity> queue_;  // guarded by mutex_, as all down to dropped_
  std::size_t size_ = 0;
  std::unordered_set<std::uint32_t> missed_;                  // keys in the queue
  std::unordered_map<std::uint64_t, MatchedWriter> matched_;  // by identity
  std::uint32_t dropped_ = 0;
  std::uint32_t dropped_before_ = 0;  // at the last look
  std::array<ReaderEvent, kCapacity> taken_;
  std::vector<MatchedWriter> taken_matched_;
};

}  // namespace giveway::link
