// Which vehicle each discovered writer speaks for, by the `v<id>` of its partition. A sample whose
// id is another one is not believed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "services/link/fastdds/fastdds_version.h"
#include "services/types/ids.h"

namespace giveway::link {

// The vehicle named by a writer's partitions: exactly one partition whose last part is `v<id>`.
// kNoVehicle for anything else: wildcards, several partitions, leading zeros, numbers out of range.
VehicleId NamedVehicle(const std::vector<std::string>& partitions);
// The area of a writer of beacons, whose partition is `<area>/v<id>`; empty for any other writer.
std::string BeaconArea(const std::vector<std::string>& partitions);

// 64 bits that stand for one endpoint; never 0. Mixed from all of its GUID, so that two among a
// thousand endpoints coincide about once in 10^13 fleets.
std::uint64_t Identity(const rtps::GUID_t& endpoint);

rtps::GUID_t GuidOf(const dds::InstanceHandle_t& handle);

// What the link knows of one writer.
struct WriterEntry {
  VehicleId vehicle = kNoVehicle;  // named by its partition
  std::string area;                // of a writer of beacons, else empty
  std::uint64_t identity = 0;
  // Of the last sample taken from it; 0 before the first, and before the first since it was found
  // again.
  std::uint64_t last_sequence = 0;
  std::uint32_t taken = 0;       // samples; wraps
  std::uint32_t unreadable = 0;  // of those; wraps
  bool gone = false;             // left; may be found again
  std::uint64_t found = 0;       // 1, 2, 3 ... in the order of first discovery
};

class WriterNames final : public DiscoveryListener {
 public:
  // The library's side: only queues.
  void OnWriter(Change change, const rtps::GUID_t& writer,
                const std::vector<std::string>& partitions) override;

  // The writer last reported to any WriterNames on the calling thread; unknown if there was none.
  static const rtps::GUID_t& FoundByThisThread();

  // The loop's side: applies what was queued. Discovery of a writer is queued before any sample or
  // event of it can be.
  void Update();
  // Null if the writer is not known. Valid until the next Update.
  WriterEntry* Find(const rtps::GUID_t& writer);
  const WriterEntry* Find(const rtps::GUID_t& writer) const;
  const WriterEntry* Find(std::uint64_t identity) const;
  // Identities of those that the last Update learnt to have left.
  const std::vector<std::uint64_t>& LeftNow() const { return left_now_; }
  // Calls visit(entry) of every writer that is there, in no order.
  template <typename Visit>
  void ForEach(Visit&& visit) const {
    for (const auto& [identity, entry] : writers_) {
      if (!entry.gone) visit(entry);
    }
  }

 private:
  struct Gone {
    std::uint64_t identity;
    std::uint64_t update;  // the one that applied it
  };
  struct Queued {
    Change change;
    std::uint64_t identity;
    VehicleId vehicle;
    std::string area;
  };
  void ForgetGone();

  std::mutex mutex_;
  std::vector<Queued> queue_;  // guarded by mutex_
  std::vector<Queued> batch_;
  std::vector<std::uint64_t> left_now_;
  std::unordered_map<std::uint64_t, WriterEntry> writers_;  // by identity
  std::uint64_t found_ = 0;                                 // writers ever discovered
  std::uint64_t updates_ = 0;
  std::deque<Gone> gone_;  // still in writers_, oldest first
};

}  // namespace giveway::link
