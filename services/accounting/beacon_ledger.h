// Keeps the account of each writer of beacons that a vehicle hears (README.md). Fed once a step,
// after the brain has judged; bounded. Decides nothing. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "services/types/beacon.h"
#include "services/types/figures/beacon_account.h"

namespace giveway {

class BeaconLedger {
 public:
  // As many as peers. Where there are more the one that was silent longest departs.
  static constexpr std::size_t kMostWriters = 1024;
  // The last beacons of a writer may be taken so many steps after the news that it left.
  static constexpr std::uint64_t kStepsToLeave = 3;
  // So many beacons in a row whose two numbers differ by another amount than before, all by the
  // same, are a new count; fewer may be corrupted in the same bit.
  static constexpr std::uint32_t kNewCount = 10;

  // What became of the beacons of one step: fates[i] of beacons[i].
  void Note(std::span<const ReceivedBeacon> beacons, std::span<const BeaconFate> fates);
  // These writers have left; of others nothing is known here.
  void NoteLeft(std::span<const std::uint64_t> writers);

  // The next rows, in turn.
  ReportedAccounts NextRows();
  const AccountSums& Departed() const { return departed_; }
  std::size_t Writers() const { return rows_.size(); }

 private:
  struct Row {
    BeaconAccount settled;          // `last` is 0 until it is settled for the first time
    BeaconArrival base;             // all counts before the first beacon of the account
    std::uint64_t sequence = 0;     // the library's number of that one
    std::uint64_t apart = 0;        // the library's number less the writer's, modulo 2^64
    std::uint64_t odd_apart = 0;    // of the newest beacon, where it differs
    std::uint32_t odd_beacons = 0;  // one after the other that were as far apart
    BeaconAccount judged;           // since the base; by the brain alone
    std::uint32_t taken = 0;        // since the base
    std::uint32_t unreadable = 0;
    std::uint64_t counted_at = 0;  // the last step with a beacon of it
    std::optional<std::uint64_t> leaves_at;

    // Of one step.
    std::uint64_t highest = 0;                // of the library's numbers
    bool numbers_unknown = false;             // the library's number of one is not known
    const ReceivedBeacon* newest = nullptr;   // that can settle the row
    BeaconFate fate = BeaconFate::kAccepted;  // of newest
  };
  using Rows = std::map<std::uint64_t, Row>;

  // The account starts with this beacon.
  static void Begin(const ReceivedBeacon& received, BeaconFate fate, Row* row);
  void Count(const ReceivedBeacon& received, BeaconFate fate, Row* row);
  static void Settle(Row* row);
  bool HasRoom();
  Rows::iterator Remove(Rows::iterator row);

  Rows rows_;                  // by the writer's identity
  std::vector<Row*> counted_;  // by one step
  std::uint64_t step_ = 0;
  std::uint64_t reported_ = 0;  // the last row that was
  AccountSums departed_;
};

}  // namespace giveway
