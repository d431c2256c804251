#include "services/accounting/fleet_accounting.h"

#include <gtest/gtest.h>

namespace giveway {
namespace {

constexpr VehicleId kReader{2};
constexpr VehicleId kWriter{5};

BeaconAccount Account(std::uint32_t boot, std::uint32_t first, std::uint32_t last) {
  return {.writer = kWriter,
          .boot_epoch = boot,
          .first = first,
          .last = last,
          .accepted = last - first,
          .lost = 1};
}

VehicleStatus Status(const ReportedAccounts& accounts, VehicleId reader = kReader) {
  VehicleStatus status;
  status.vehicle = reader;
  status.accounts = accounts;
  return status;
}

TEST(FleetAccounting, HasTheNewestOfEachPair) {
  FleetAccounting accounting;
  accounting.Fold(Status({Account(1, 1, 10)}));
  accounting.Fold(Status({Account(1, 1, 30)}));
  accounting.Fold(Status({}));
  accounting.Fold(Status({Account(1, 1, 20)}, VehicleId{3}));
  const auto pairs = accounting.Pairs();
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].reader, kReader);
  EXPECT_EQ(pairs[0].writer, kWriter);
  EXPECT_EQ(pairs[0].sums.sent, 30U);
  EXPECT_EQ(pairs[0].sums.accepted, 29U);
  EXPECT_EQ(pairs[0].sums.lost, 1U);
  EXPECT_EQ(pairs[0].differing, 0U);
  EXPECT_EQ(pairs[1].sums.sent, 20U);
}

TEST(FleetAccounting, AddsUpTheLivesOfWriterAndReader) {
  FleetAccounting accounting;
  accounting.Fold(Status({Account(1, 1, 10)}));
  accounting.Fold(Status({Account(1, 1, 12), Account(2, 1, 3)}));  // both are still matched
  accounting.Fold(Status({Account(1, 1, 12), Account(2, 1, 8)}));
  accounting.Fold(Status({Account(2, 20, 24)}));  // another life of the reader
  accounting.Fold(Status({Account(2, 20, 22)}));  // the same with an equal start
  EXPECT_EQ(accounting.Pairs().at(0).sums.sent, 12U + 8 + 5 + 3);
  for (std::uint32_t boot = 10; boot < 30; ++boot) accounting.Fold(Status({Account(boot, 1, 2)}));
  EXPECT_EQ(accounting.Pairs().at(0).sums.sent, 28U + 20 * 2);
}

TEST(FleetAccounting, ADifferenceOfOneLifeStays) {
  FleetAccounting accounting;
  BeaconAccount off = Account(1, 1, 10);
  off.accepted -= 2;
  accounting.Fold(Status({off}));
  for (std::uint32_t boot = 10; boot < 30; ++boot) {
    BeaconAccount too_many = Account(boot, 1, 2);
    too_many.accepted += boot == 10 ? 2 : 0;
    accounting.Fold(Status({too_many}));
  }
  EXPECT_EQ(accounting.Pairs().at(0).sums.Difference(), 0);
  EXPECT_EQ(accounting.Pairs().at(0).differing, 4U);
}

TEST(FleetAccounting, TellsOfWritersThatLeftWithADifference) {
  FleetAccounting accounting;
  VehicleStatus status = Status({});
  status.departed += Account(1, 1, 10);
  accounting.Fold(status);
  EXPECT_TRUE(accounting.DepartedDiffering().empty());
  status.departed.refused = 3;
  accounting.Fold(status);
  EXPECT_EQ(accounting.DepartedDiffering().at(kReader), 3U);
}

TEST(FleetAccounting, TellsWhoAcceptsBeaconsAndReportsNoAccount) {
  FleetAccounting accounting;
  VehicleStatus status = Status({});
  accounting.Fold(status);
  EXPECT_TRUE(accounting.WithoutAccount().empty());
  status.beacons.accepted = 1;
  accounting.Fold(status);
  EXPECT_EQ(accounting.WithoutAccount(), std::vector{kReader});
  accounting.Fold(Status({Account(1, 1, 10)}));
  accounting.Fold(status);
  EXPECT_TRUE(accounting.WithoutAccount().empty());
}

// One account of each of so many readers, from number `first` on.
void FoldReaders(std::uint32_t first, std::size_t readers, std::uint32_t missing,
                 FleetAccounting* accounting) {
  BeaconAccount account = Account(1, 1, 5);
  account.accepted -= missing;
  for (std::uint32_t i = first; i < first + readers; ++i) {
    accounting->Fold(Status({account}, VehicleId{i}));
  }
}

TEST(FleetAccounting, KeepsABoundedNumberOfPairs) {
  constexpr std::size_t kMost = FleetAccounting::kMostPairs;
  FleetAccounting accounting;
  FoldReaders(1, kMost + 2, 0, &accounting);
  EXPECT_EQ(accounting.Pairs().size(), kMost);
  FoldReaders(2 * kMost, kMost + 2, 1, &accounting);
  EXPECT_EQ(accounting.Pairs().size(), 2 * kMost);
}

// From 72 vehicles on there are more pairs than are kept: beacons of the others could be missing.
TEST(FleetAccounting, ADifferenceOfAPairBeyondTheKeptOnesIsKept) {
  constexpr std::uint32_t kMost = FleetAccounting::kMostPairs;
  FleetAccounting accounting;
  FoldReaders(1, kMost, 0, &accounting);
  FoldReaders(kMost + 1, 1, 0, &accounting);
  FoldReaders(kMost + 2, 1, 3, &accounting);
  const auto pairs = accounting.Pairs();
  ASSERT_EQ(pairs.size(), kMost + 1);
  EXPECT_EQ(pairs.back().reader, VehicleId{kMost + 2});
  EXPECT_EQ(pairs.back().differing, 3U);
}

}  // namespace
}  // namespace giveway
