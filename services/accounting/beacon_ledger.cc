#include "services/accounting/beacon_ledger.h"

#include <algorithm>

namespace giveway {
namespace {

// Whether its own number can be believed, and the library's is known.
bool IsSound(const ReceivedBeacon& received) {
  return received.crc_valid && received.name_valid && received.beacon.seq != 0 &&
         received.arrival.sequence != 0;
}

std::uint64_t Apart(const ReceivedBeacon& received) {
  return received.arrival.sequence - received.beacon.seq;
}

void Add(BeaconFate fate, BeaconAccount* judged) {
  switch (fate) {
    case BeaconFate::kAccepted:
      ++judged->accepted;
      return;
    case BeaconFate::kNotHeard:
      ++judged->not_heard;
      return;
    case BeaconFate::kRefused:
      ++judged->refused;
      return;
  }
}

}  // namespace

void BeaconLedger::Begin(const ReceivedBeacon& received, BeaconFate fate, Row* row) {
  row->settled = {.writer = received.beacon.vehicle,
                  .boot_epoch = received.beacon.boot_epoch,
                  .first = received.beacon.seq};
  row->base = received.arrival;
  --row->base.arrived;
  --row->base.taken;
  row->sequence = received.arrival.sequence;
  row->apart = Apart(received);
  row->odd_beacons = 0;
  row->judged = {};
  Add(fate, &row->judged);
  row->taken = 1;
  row->unreadable = 0;
}

// A beacon with a broken id is of another instance of the reader: within one step the beacons of a
// writer are not all in order.
void BeaconLedger::Count(const ReceivedBeacon& received, BeaconFate fate, Row* row) {
  const BeaconArrival& arrival = received.arrival;
  if (arrival.sequence != 0 && arrival.sequence < row->sequence) {
    ++row->base.taken;  // it came before the first
    return;
  }
  if (row->counted_at != step_) counted_.push_back(row);
  row->counted_at = step_;
  Add(fate, &row->judged);
  row->taken = std::max(row->taken, arrival.taken - row->base.taken);
  row->unreadable = std::max(row->unreadable, arrival.unreadable - row->base.unreadable);
  row->numbers_unknown = row->numbers_unknown || arrival.sequence == 0;
  if (arrival.sequence < row->highest) return;
  row->highest = arrival.sequence;
  const bool settles = IsSound(received) && received.beacon.boot_epoch == row->settled.boot_epoch;
  row->newest = settles ? &received : nullptr;
  row->fate = fate;
}

void BeaconLedger::Note(std::span<const ReceivedBeacon> beacons,
                        std::span<const BeaconFate> fates) {
  ++step_;
  const std::size_t judged = std::min(beacons.size(), fates.size());
  for (std::size_t i = 0; i < judged; ++i) {
    const auto row = rows_.find(beacons[i].writer);
    if (row != rows_.end()) {
      Count(beacons[i], fates[i], &row->second);
    } else if (IsSound(beacons[i]) && HasRoom()) {
      Row& begun = rows_[beacons[i].writer];
      Begin(beacons[i], fates[i], &begun);
      begun.counted_at = step_;
      counted_.push_back(&begun);
    }
  }
  for (Row* row : counted_) {
    if (row->newest != nullptr && !row->numbers_unknown) Settle(row);
    row->highest = 0;
    row->numbers_unknown = false;
    row->newest = nullptr;
  }
  counted_.clear();
  for (auto row = rows_.begin(); row != rows_.end();) {
    row = row->second.leaves_at && *row->second.leaves_at <= step_ ? Remove(row) : std::next(row);
  }
}

void BeaconLedger::Settle(Row* row) {
  const ReceivedBeacon& newest = *row->newest;
  const BeaconArrival& now = newest.arrival;
  const bool is_first = row->settled.last == 0;
  const bool log_restarted = now.arrived < row->base.arrived;
  if ((is_first && Apart(newest) != row->apart) || log_restarted) {
    return Begin(newest, row->fate, row);  // either of the two numbers may be the corrupted one
  }
  if (Apart(newest) != row->apart) {
    // The library's number was corrupted in its packet, or the writer has skipped or reused a
    // number, which is a difference from now on. A reader takes no number below a corrupted one, so
    // packets corrupted in the same bit may come one after the other.
    if (row->odd_apart != Apart(newest)) row->odd_beacons = 0;
    row->odd_apart = Apart(newest);
    if (++row->odd_beacons < kNewCount) return;
    row->apart = Apart(newest);
  }
  row->odd_beacons = 0;
  BeaconAccount& settled = row->settled;
  const std::uint32_t filtered = now.filtered - row->base.filtered;
  settled.last = newest.beacon.seq;
  settled.accepted = row->judged.accepted;
  settled.not_heard = row->judged.not_heard;
  settled.refused = row->judged.refused + row->unreadable + filtered;
  settled.superseded = now.arrived - row->base.arrived - filtered - row->taken;
  settled.lost = now.missing - row->base.missing;
}

// Of one that speaks in this step nothing is removed.
bool BeaconLedger::HasRoom() {
  if (rows_.size() < kMostWriters) return true;
  const auto silent = std::ranges::min_element(
      rows_, {}, [](const auto& entry) { return entry.second.counted_at; });
  if (silent->second.counted_at == step_) return false;
  Remove(silent);
  return true;
}

BeaconLedger::Rows::iterator BeaconLedger::Remove(Rows::iterator row) {
  if (row->second.settled.last != 0) departed_ += row->second.settled;
  return rows_.erase(row);
}

void BeaconLedger::NoteLeft(std::span<const std::uint64_t> writers) {
  for (const std::uint64_t writer : writers) {
    const auto row = rows_.find(writer);
    if (row != rows_.end()) row->second.leaves_at = step_ + kStepsToLeave;
  }
}

ReportedAccounts BeaconLedger::NextRows() {
  ReportedAccounts next;
  auto row = rows_.upper_bound(reported_);
  for (std::size_t seen = 0; seen < rows_.size(); ++seen) {
    if (row == rows_.end()) row = rows_.begin();
    if (row->second.settled.last != 0 && !next.Add(row->second.settled)) break;
    reported_ = row->first;
    ++row;
  }
  return next;
}

}  // namespace giveway
