// What became of the beacons of one writer at one reader: every number that the writer gave out
// between the first and the last one heard, counted exactly once. Kept by services/accounting;
// travels in fleet/status. Trivially copyable.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>

#include "services/types/ids.h"

namespace giveway {

// What a brain did with a beacon that it was handed.
enum class BeaconFate : std::uint8_t { kAccepted, kNotHeard, kRefused };

// Counts of one writer's samples as one of them arrived. Those but `sequence` wrap at 2^32: only
// their differences mean something.
struct BeaconArrival {
  std::uint64_t sequence = 0;    // as the middleware numbers samples; 0: nothing is known
  std::uint32_t arrived = 0;     // this one included
  std::uint32_t missing = 0;     // numbers below this one that had not arrived
  std::uint32_t filtered = 0;    // arrived, and kept out of the reader by a filter
  std::uint32_t taken = 0;       // out of the reader; this one and unreadable ones included
  std::uint32_t unreadable = 0;  // taken, and of no known meaning

  friend bool operator==(const BeaconArrival&, const BeaconArrival&) = default;
};

// One writer, while it is matched.
struct BeaconAccount {
  VehicleId writer = kNoVehicle;
  std::uint32_t boot_epoch = 0;
  std::uint32_t first = 0;  // as the writer numbers its beacons
  std::uint32_t last = 0;   // all up to here are counted below
  std::uint32_t accepted = 0;
  std::uint32_t not_heard = 0;   // stated from beyond the emission radius, or before a world
  std::uint32_t refused = 0;     // by the filter, as unreadable, or by the brain
  std::uint32_t superseded = 0;  // arrived, and overwritten in the reader before they were taken
  std::uint32_t lost = 0;        // never arrived

  std::uint32_t Sent() const { return last == 0 ? 0 : last - first + 1; }
  // 0, or something is counted twice or not at all.
  std::int64_t Difference() const {
    return std::int64_t{Sent()} - accepted - not_heard - refused - superseded - lost;
  }
  friend bool operator==(const BeaconAccount&, const BeaconAccount&) = default;
};

// Accounts added up: of all writers that have left, or of all lives of one.
struct AccountSums {
  std::uint32_t writers = 0;
  std::uint64_t sent = 0;
  std::uint64_t accepted = 0;
  std::uint64_t not_heard = 0;
  std::uint64_t refused = 0;
  std::uint64_t superseded = 0;
  std::uint64_t lost = 0;

  AccountSums& operator+=(const BeaconAccount& account) {
    ++writers;
    sent += account.Sent();
    accepted += account.accepted;
    not_heard += account.not_heard;
    refused += account.refused;
    superseded += account.superseded;
    lost += account.lost;
    return *this;
  }
  std::int64_t Difference() const {
    return static_cast<std::int64_t>(sent) -
           static_cast<std::int64_t>(accepted + not_heard + refused + superseded + lost);
  }
  friend bool operator==(const AccountSums&, const AccountSums&) = default;
};

// The rows of one report; where there are more each report has the next ones.
class ReportedAccounts {
 public:
  static constexpr std::size_t kMost = 8;

  ReportedAccounts() = default;
  ReportedAccounts(std::initializer_list<BeaconAccount> rows) {
    for (const BeaconAccount& row : rows) Add(row);
  }
  // False where the table is full.
  bool Add(const BeaconAccount& row) {
    if (count_ == kMost) return false;
    rows_[count_++] = row;
    return true;
  }
  std::span<const BeaconAccount> Rows() const { return {rows_.data(), count_}; }

  friend bool operator==(const ReportedAccounts&, const ReportedAccounts&) = default;

 private:
  std::array<BeaconAccount, kMost> rows_{};
  std::size_t count_ = 0;
};

}  // namespace giveway
