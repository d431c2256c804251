// Every beacon that a real writer sent is accounted for by a real reader, whatever happens to its
// packets below the library. Counting itself is tested in tests/unit/accounting and
// arrival_log_test.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

#include "services/accounting/beacon_ledger.h"
#include "tests/link/fleet.h"

namespace giveway::test {
namespace {

using std::chrono::milliseconds;

constexpr VehicleId kListener{1000};
constexpr VehicleId kThree{3};

// A vehicle that accepts every sound beacon, and keeps account of it.
class Reader {
 public:
  explicit Reader(const link::LinkOptions& options) : link_(options) { link_.Open(kListener); }

  void Listen() {
    const link::Taken taken = link_.Take(SteadyTime{1});
    ledger_.NoteLeft(taken.left);
    std::vector<BeaconFate> fates;
    for (const ReceivedBeacon& received : taken.inputs.beacons) {
      const bool sound = received.crc_valid && received.name_valid;
      fates.push_back(sound ? BeaconFate::kAccepted : BeaconFate::kRefused);
      ++taken_;
    }
    ledger_.Note(taken.inputs.beacons, fates);
    const ReportedAccounts reported = ledger_.NextRows();
    if (!reported.Rows().empty()) newest_ = reported.Rows().front();
    if (taken.beacon_latency) longest_latency_ = std::max(longest_latency_, *taken.beacon_latency);
  }
  // The row of the only writer; that it accounts for everything is checked here.
  const BeaconAccount& Account() const {
    EXPECT_EQ(newest_.Difference(), 0)
        << newest_.Sent() << " sent, " << newest_.accepted << " accepted, " << newest_.refused
        << " refused, " << newest_.superseded << " superseded, " << newest_.lost << " lost";
    return newest_;
  }
  std::uint32_t Taken() const { return taken_; }
  const BeaconLedger& Ledger() const { return ledger_; }
  Nanoseconds LongestLatency() const { return longest_latency_; }
  link::VehicleLink& Link() { return link_; }

 private:
  link::VehicleLink link_;
  BeaconLedger ledger_;
  BeaconAccount newest_;
  std::uint32_t taken_ = 0;
  Nanoseconds longest_latency_{0};
};

// Sends, and listens after each; at the end until the last of what was taken is settled.
void SendAndListen(Beaconing& sender, Reader& reader, std::uint32_t sends) {
  for (std::uint32_t i = 0; i < sends; ++i) {
    sender.Send();
    std::this_thread::sleep_for(milliseconds(1));
    reader.Listen();
    reader.Account();
  }
}

TEST(Accounting, WithoutImpairmentEveryBeaconIsAccepted) {
  const DomainLock domain;
  Beaconing sender(OptionsIn(domain), kThree);
  Reader reader(OptionsIn(domain));
  ASSERT_TRUE(Eventually([&] {
    SendAndListen(sender, reader, 1);
    return reader.Account().accepted >= 50;
  }));
  const BeaconAccount& account = reader.Account();
  EXPECT_EQ(account.writer, kThree);
  EXPECT_EQ(account.lost, 0U);
  EXPECT_EQ(account.refused, 0U);
  EXPECT_GT(reader.LongestLatency(), Nanoseconds{0});
  EXPECT_LT(reader.LongestLatency(), std::chrono::seconds(20)) << "one clock of one host";
}

TEST(Accounting, WhatIsOverwrittenBeforeADrainIsSupersededAndNotLost) {
  const DomainLock domain;
  Beaconing sender(OptionsIn(domain), kThree);
  Reader reader(OptionsIn(domain));
  ASSERT_TRUE(Eventually([&] {
    SendAndListen(sender, reader, 1);
    return reader.Account().accepted >= 5;
  }));
  const std::uint32_t before = reader.Account().superseded;
  for (int i = 0; i < 30; ++i) sender.Send();
  std::this_thread::sleep_for(milliseconds(200));  // lets them all arrive undrained
  ASSERT_TRUE(Eventually([&] {
    SendAndListen(sender, reader, 1);
    return reader.Account().superseded >= before + 20;
  }));
  EXPECT_EQ(reader.Account().lost, 0U);
  EXPECT_EQ(reader.Account().superseded, reader.Link().Counters().beacons_superseded)
      << "as the gaps say, less what the library reports lost";
}

TEST(Accounting, LossDuplicatesReorderingAndDelayLeaveNoDifference) {
  const DomainLock domain;
  link::LinkOptions options = OptionsIn(domain);
  options.impairment = {.seed = 7,
                        .rules = {{.loss = 0.3,
                                   .delay_s = 0.002,
                                   .jitter_s = 0.002,
                                   .reorder = 0.1,
                                   .reorder_by_s = 0.01,
                                   .duplicate = 0.3}}};
  Beaconing sender(OptionsIn(domain), kThree);
  Reader reader(options);
  ASSERT_TRUE(Eventually([&] {
    SendAndListen(sender, reader, 10);
    return reader.Account().Sent() >= 500;
  }));
  const BeaconAccount& account = reader.Account();
  EXPECT_GT(account.lost, account.Sent() / 6);
  // What was overtaken is lost too, and how much that is depends on how the machine paces it.
  EXPECT_LT(account.lost, account.Sent() / 4 * 3);
  EXPECT_EQ(account.refused, 0U);
  EXPECT_GT(reader.Link().Impaired()->duplicated, 10U);
}

// Whether some were refused and some lost, without a difference.
bool AccountsForCorruptedPackets(const DomainLock& domain, std::uint64_t seed) {
  link::LinkOptions options = OptionsIn(domain);
  options.impairment = {.seed = seed, .rules = {{.loss = 0.1, .duplicate = 0.1, .corrupt = 0.4}}};
  Beaconing sender(OptionsIn(domain), kThree);
  Reader reader(options);
  return Eventually(
      [&] {
        SendAndListen(sender, reader, 10);
        return reader.Account().refused >= 10 && reader.Account().lost >= 3;
      },
      std::chrono::seconds(10));
}

// In the first second of a writer the packet filter lets its numbers jump by up to 2^24. A
// corrupted number among those makes the library drop all lower ones as old: then another pair is
// tried.
TEST(Accounting, CorruptedPacketsAreRefusedOrLostAndLeaveNoDifference) {
  const DomainLock domain;
  bool accounted = false;
  for (std::uint64_t seed = 7; seed < 17 && !accounted; ++seed) {
    accounted = AccountsForCorruptedPackets(domain, seed);
  }
  EXPECT_TRUE(accounted);
}

TEST(Accounting, AWriterThatLeavesFreesItsRow) {
  const DomainLock domain;
  Reader reader(OptionsIn(domain));
  {
    Beaconing sender(OptionsIn(domain), kThree);
    ASSERT_TRUE(Eventually([&] {
      SendAndListen(sender, reader, 1);
      return reader.Account().accepted >= 5;
    }));
  }
  ASSERT_TRUE(Eventually([&] {
    reader.Listen();
    return reader.Ledger().Writers() == 0;
  }));
  EXPECT_EQ(reader.Ledger().Departed().writers, 1U);
  EXPECT_EQ(reader.Ledger().Departed().sent, reader.Account().Sent());
}

}  // namespace
}  // namespace giveway::test
