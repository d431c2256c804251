// Which participant speaks for each vehicle, and for the world, by what discovery says of writers:
// the first that is there. Passes everything on to WriterNames.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "services/link/fastdds/writer_names.h"

namespace giveway::link {

class ParticipantNames final : public DiscoveryListener {
 public:
  // The library's side.
  void OnWriter(Change change, const rtps::GUID_t& writer,
                const std::vector<std::string>& partitions) override;

  // The loop's side.
  WriterNames& Writers() { return writers_; }
  // Whether `endpoint` is of the participant that has spoken longest for the vehicle, of those that
  // are there; kNoVehicle is the world. Of a vehicle that is a writer of beacons.
  bool Owns(VehicleId vehicle, const rtps::GUID_t& endpoint) const;
  // Whether the participant is there and speaks as a world.
  bool IsWorld(std::uint64_t participant) const;
  // The participant that has spoken longest as a world, of those that are there; 0: none is.
  std::uint64_t World() const;

 private:
  static constexpr std::size_t kMostWriters = 16'384;

  struct Speaker {
    VehicleId vehicle = kNoVehicle;
    std::uint64_t participant = 0;
    std::uint64_t found = 0;  // 1, 2, 3 ...
  };

  // The participant that has spoken longest for the vehicle; 0: none. Under the lock.
  std::uint64_t FirstOf(VehicleId vehicle) const;

  WriterNames writers_;
  mutable std::mutex mutex_;
  std::unordered_map<std::uint64_t, Speaker> speakers_;  // by writer; guarded by mutex_
  std::uint64_t found_ = 0;                              // guarded by mutex_
};

}  // namespace giveway::link
