#include "services/accounting/beacon_ledger.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace giveway {
namespace {

constexpr VehicleId kPeer{7};
constexpr std::uint32_t kBoot = 77;

// A writer, the network to one reader, and the reader's inbox: what each of them counts.
class Writer {
 public:
  explicit Writer(std::uint64_t identity = 1) : identity_(identity) {}

  // The next beacon, as it comes out of the reader.
  ReceivedBeacon Arrives() { return Taken(Sent()); }
  // The next one never arrives, is kept out by a filter, or is overwritten before it is taken.
  void Lose() { Next(), ++pending_missing_; }
  void Filter() { Next(), Arrive(), ++arrival_.filtered; }
  void Overwrite() { Next(), Arrive(); }
  // Taken, but of unknown meaning.
  void Unreadable() { Overwrite(), ++arrival_.taken, ++arrival_.unreadable; }
  // Counted by the writer alone: the library got no sample.
  void Skip() { ++seq_; }

  ReceivedBeacon Sent() {
    Next();
    ReceivedBeacon received;
    received.beacon.vehicle = kPeer;
    received.beacon.boot_epoch = kBoot;
    received.beacon.seq = seq_;
    received.crc_valid = received.name_valid = true;
    received.writer = identity_;
    return received;
  }
  ReceivedBeacon Taken(ReceivedBeacon received) {
    Arrive();
    ++arrival_.taken;
    received.arrival = arrival_;
    return received;
  }

 private:
  void Next() { ++seq_, ++sequence_; }
  void Arrive() {
    arrival_.missing += pending_missing_;
    pending_missing_ = 0;
    ++arrival_.arrived;
    arrival_.sequence = sequence_;
  }

  std::uint64_t identity_;
  std::uint32_t seq_ = 0;
  std::uint64_t sequence_ = 0;
  std::uint32_t pending_missing_ = 0;
  BeaconArrival arrival_;
};

class BeaconLedgerTest : public ::testing::Test {
 protected:
  void Note(std::vector<ReceivedBeacon> beacons, BeaconFate fate = BeaconFate::kAccepted) {
    ledger_.Note(beacons, std::vector<BeaconFate>(beacons.size(), fate));
  }
  void NoteNext(BeaconFate fate = BeaconFate::kAccepted) { Note({writer_.Arrives()}, fate); }
  // The header of its packet was corrupted: the library takes it for a later one, and then drops
  // those it skipped.
  void NoteMisnumbered() {
    constexpr std::uint32_t kSkipped = 4;
    for (std::uint32_t i = 0; i < kSkipped; ++i) writer_.Lose();
    ReceivedBeacon received = writer_.Sent();
    received.beacon.seq -= kSkipped;
    Note({writer_.Taken(received)});
  }
  // The only row, without names.
  BeaconAccount Row() {
    const BeaconAccount row = RowWithADifference();
    EXPECT_EQ(row.Difference(), 0);
    return row;
  }
  BeaconAccount RowWithADifference() {
    const ReportedAccounts reported = ledger_.NextRows();
    EXPECT_EQ(reported.Rows().size(), 1U);
    return reported.Rows().size() == 1 ? reported.Rows()[0] : BeaconAccount{};
  }

  Writer writer_;
  BeaconLedger ledger_;
};

TEST_F(BeaconLedgerTest, CountsEachFateOfABeaconOnce) {
  NoteNext();
  EXPECT_TRUE(ledger_.NextRows().Rows().empty()) << "one alone proves nothing about the numbers";
  NoteNext();
  NoteNext(BeaconFate::kNotHeard);
  NoteNext(BeaconFate::kRefused);
  NoteNext(BeaconFate::kRefused);
  NoteNext();
  const BeaconAccount expected{.writer = kPeer,
                               .boot_epoch = kBoot,
                               .first = 1,
                               .last = 6,
                               .accepted = 3,
                               .not_heard = 1,
                               .refused = 2};
  EXPECT_EQ(Row(), expected);
}

TEST_F(BeaconLedgerTest, TellsWhatIsLostFromWhatIsSuperseded) {
  NoteNext();
  for (int i = 0; i < 3; ++i) writer_.Lose();
  for (int i = 0; i < 5; ++i) writer_.Overwrite();
  NoteNext();
  const BeaconAccount row = Row();
  EXPECT_EQ(row.Sent(), 10U);
  EXPECT_EQ(row.lost, 3U);
  EXPECT_EQ(row.superseded, 5U);
  EXPECT_EQ(row.accepted, 2U);
}

TEST_F(BeaconLedgerTest, WhatAFilterOrTheConversionDropsIsRefused) {
  NoteNext();
  writer_.Filter();
  NoteNext();
  writer_.Unreadable();
  writer_.Unreadable();
  NoteNext();
  const BeaconAccount row = Row();
  EXPECT_EQ(row.refused, 3U);
  EXPECT_EQ(row.superseded, 0U);
  EXPECT_EQ(row.Sent(), 6U);
}

TEST_F(BeaconLedgerTest, OneThatIsTakenAndNotJudgedIsADifference) {
  NoteNext();
  writer_.Arrives();
  NoteNext();
  EXPECT_EQ(RowWithADifference().Difference(), 1);
}

TEST_F(BeaconLedgerTest, WhatCameBeforeTheFirstIsOfNoRow) {
  for (int i = 0; i < 4; ++i) writer_.Lose();
  ReceivedBeacon broken = writer_.Arrives();
  broken.crc_valid = false;
  Note({broken}, BeaconFate::kRefused);
  NoteNext();
  NoteNext();
  const BeaconAccount row = Row();
  EXPECT_EQ(row.first, 6U);
  EXPECT_EQ(row.refused, 0U);
  EXPECT_EQ(row.Sent(), 2U);
}

// Its own number cannot be trusted, so the row waits for the next intact one.
TEST_F(BeaconLedgerTest, ABrokenBeaconIsCountedWithTheNextSoundOne) {
  NoteNext();
  NoteNext();
  ReceivedBeacon broken = writer_.Sent();
  broken.crc_valid = false;
  broken.beacon.seq = 4'000'000;
  const ReceivedBeacon sound_before = writer_.Taken(broken);
  Note({sound_before}, BeaconFate::kRefused);
  EXPECT_EQ(Row().last, 2U);
  EXPECT_EQ(Row().refused, 0U);
  NoteNext();
  EXPECT_EQ(Row().last, 4U);
  EXPECT_EQ(Row().refused, 1U);
}

// Within one step, a sound one is followed by a broken one; or the broken one, of another instance,
// is handed over first or last.
TEST_F(BeaconLedgerTest, TheOrderWithinAStepDoesNotMatter) {
  NoteNext();
  NoteNext();
  const ReceivedBeacon third = writer_.Arrives();
  ReceivedBeacon fourth = writer_.Arrives();
  fourth.crc_valid = false;
  const std::vector<BeaconFate> fates{BeaconFate::kAccepted, BeaconFate::kRefused};
  ledger_.Note(std::vector{third, fourth}, fates);
  EXPECT_EQ(Row().last, 2U);
  const ReceivedBeacon fifth = writer_.Arrives();
  ReceivedBeacon sixth = writer_.Arrives();
  ReceivedBeacon seventh = writer_.Arrives();
  sixth.name_valid = false;
  std::swap(sixth.arrival.taken, seventh.arrival.taken);  // it was taken last
  ledger_.Note(std::vector{fifth, seventh, sixth},
               std::vector{BeaconFate::kAccepted, BeaconFate::kAccepted, BeaconFate::kRefused});
  EXPECT_EQ(Row().last, 7U);
  EXPECT_EQ(Row().refused, 2U);
}

TEST_F(BeaconLedgerTest, OneOfAnotherInstanceMayHaveComeBeforeTheFirst) {
  ReceivedBeacon broken = writer_.Arrives();
  ReceivedBeacon first = writer_.Arrives();
  broken.name_valid = false;
  std::swap(broken.arrival.taken, first.arrival.taken);  // it was taken last
  ledger_.Note(std::vector{first, broken},
               std::vector{BeaconFate::kAccepted, BeaconFate::kRefused});
  NoteNext();
  EXPECT_EQ(Row().first, 2U);
  EXPECT_EQ(Row().Sent(), 2U);
}

TEST_F(BeaconLedgerTest, ALibraryNumberThatWasBrokenIsMadeUpForByTheNext) {
  NoteNext();
  NoteNext();
  NoteMisnumbered();
  EXPECT_EQ(Row().last, 2U) << "it proves nothing";
  NoteNext();
  EXPECT_EQ(Row().last, 8U);
  EXPECT_EQ(Row().lost, 4U);
}

TEST_F(BeaconLedgerTest, ABrokenLibraryNumberOfTheFirstStartsTheRowLater) {
  for (int i = 0; i < 4; ++i) writer_.Sent();
  ReceivedBeacon first = writer_.Sent();
  first.beacon.seq = 1;
  Note({writer_.Taken(first)});
  NoteNext();
  NoteNext();
  const BeaconAccount row = Row();
  EXPECT_EQ(row.first, 6U);
  EXPECT_EQ(row.accepted, 2U);
}

TEST_F(BeaconLedgerTest, ANumberThatTheLibraryNeverGotIsADifference) {
  NoteNext();
  NoteNext();
  writer_.Skip();
  for (std::uint32_t i = 1; i < BeaconLedger::kNewCount; ++i) NoteNext();
  EXPECT_EQ(Row().last, 2U) << "a few times, it may be the library's number";
  NoteNext();
  const BeaconAccount row = RowWithADifference();
  EXPECT_EQ(row.last, 3U + BeaconLedger::kNewCount);
  EXPECT_EQ(row.Difference(), 1);
}

// The same bit is flipped in two packets, far apart.
TEST_F(BeaconLedgerTest, TwoBrokenLibraryNumbersAreNotANewCount) {
  NoteNext();
  for (int turn = 0; turn < 2; ++turn) {
    NoteNext();
    NoteMisnumbered();
  }
  NoteNext();
  EXPECT_EQ(Row().lost, 8U);
}

// The same bit is flipped in two packets, and the library drops the intact ones between them: their
// numbers are lower.
TEST_F(BeaconLedgerTest, TwoLibraryNumbersBrokenInTheSameBitAreNotANewCount) {
  NoteNext();
  NoteNext();
  NoteMisnumbered();
  ReceivedBeacon again = writer_.Sent();
  again.beacon.seq -= 4;
  Note({writer_.Taken(again)});
  EXPECT_EQ(Row().last, 2U);
}

TEST_F(BeaconLedgerTest, WaitsWhereTheLibrarysNumberIsNotKnown) {
  NoteNext();
  NoteNext();
  ReceivedBeacon unknown = writer_.Arrives();
  unknown.arrival = {.taken = unknown.arrival.taken};
  Note({unknown, writer_.Arrives()});
  EXPECT_EQ(Row().last, 2U);
  NoteNext();
  EXPECT_EQ(Row().last, 5U);
  EXPECT_EQ(Row().accepted, 5U);
}

TEST_F(BeaconLedgerTest, OneOfAnotherLifeSettlesNothing) {
  NoteNext();
  NoteNext();
  ReceivedBeacon other = writer_.Arrives();
  other.beacon.boot_epoch = kBoot + 1;
  other.beacon.seq = 1000;
  Note({other}, BeaconFate::kRefused);
  EXPECT_EQ(Row().last, 2U);
}

TEST_F(BeaconLedgerTest, OneThatLeavesFreesItsRowAndIsAddedUp) {
  NoteNext();
  NoteNext();
  writer_.Lose();
  ledger_.NoteLeft(std::vector<std::uint64_t>{1, 99});
  NoteNext(BeaconFate::kNotHeard);  // its last one is taken after the news
  EXPECT_EQ(ledger_.Writers(), 1U);
  for (std::uint64_t i = 1; i < BeaconLedger::kStepsToLeave; ++i) Note({});
  EXPECT_EQ(ledger_.Writers(), 0U);
  EXPECT_TRUE(ledger_.NextRows().Rows().empty());
  const AccountSums expected{.writers = 1, .sent = 4, .accepted = 2, .not_heard = 1, .lost = 1};
  EXPECT_EQ(ledger_.Departed(), expected);
  EXPECT_EQ(ledger_.Departed().Difference(), 0);
}

TEST_F(BeaconLedgerTest, AFullTableLosesTheOneThatWasSilentLongest) {
  std::vector<Writer> writers;
  for (std::uint64_t id = 1; id <= BeaconLedger::kMostWriters; ++id) writers.emplace_back(id);
  for (int turn = 0; turn < 2; ++turn) {
    std::vector<ReceivedBeacon> beacons;
    for (Writer& writer : writers) beacons.push_back(writer.Arrives());
    Note(beacons);
  }
  std::vector<ReceivedBeacon> beacons;
  for (Writer& writer : writers) beacons.push_back(writer.Arrives());
  beacons.push_back(Writer(5000).Arrives());
  Note(beacons);
  EXPECT_EQ(ledger_.Departed().writers, 0U) << "all speak";
  beacons.clear();
  for (std::size_t i = 1; i < writers.size(); ++i) beacons.push_back(writers[i].Arrives());
  beacons.push_back(Writer(5000).Arrives());
  Note(beacons);
  EXPECT_EQ(ledger_.Writers(), BeaconLedger::kMostWriters);
  EXPECT_EQ(ledger_.Departed().writers, 1U);
  EXPECT_EQ(ledger_.Departed().sent, 3U);
}

TEST_F(BeaconLedgerTest, ReportsAllRowsInTurn) {
  std::vector<Writer> writers;
  for (std::uint64_t id = 1; id <= 2 * ReportedAccounts::kMost + 3; ++id) writers.emplace_back(id);
  for (int turn = 0; turn < 2; ++turn) {
    std::vector<ReceivedBeacon> beacons;
    for (Writer& writer : writers) beacons.push_back(writer.Arrives());
    for (std::size_t i = 0; i < beacons.size(); ++i) {
      beacons[i].beacon.vehicle = VehicleId{static_cast<std::uint32_t>(i + 1)};
    }
    Note(beacons);
  }
  std::vector<int> met(writers.size() + 1);
  for (int report = 0; report < 3; ++report) {
    const ReportedAccounts reported = ledger_.NextRows();
    EXPECT_EQ(reported.Rows().size(), ReportedAccounts::kMost);
    for (const BeaconAccount& row : reported.Rows()) ++met[Number(row.writer)];
  }
  for (std::size_t i = 1; i < met.size(); ++i) EXPECT_GE(met[i], 1) << i;
}

}  // namespace
}  // namespace giveway
