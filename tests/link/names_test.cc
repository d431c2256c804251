#include <gmock/gmock.h>

#include "services/link/fastdds/interfaces.h"
#include "services/link/fastdds/link_options.h"
#include "services/link/fastdds/writer_names.h"

namespace giveway::link {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(NamedVehicle, IsTheNumberAfterTheLastSlash) {
  EXPECT_EQ(NamedVehicle({"v7"}), VehicleId{7});
  EXPECT_EQ(NamedVehicle({"main/v12"}), VehicleId{12});
  EXPECT_EQ(NamedVehicle({"main/v4294967295"}), VehicleId{4294967295U});
}

TEST(NamedVehicle, IsNobodyForAnythingElse) {
  for (const char* name : {"", "v", "v0", "v07", "v-1", "v+1", "v1 ", "v1x", "w1", "7", "v*",
                           "main/*", "*", "v4294967296", "main/v1/x", "world"}) {
    EXPECT_EQ(NamedVehicle({name}), kNoVehicle) << name;
  }
  EXPECT_EQ(NamedVehicle({}), kNoVehicle);
  EXPECT_EQ(NamedVehicle({"v1", "v2"}), kNoVehicle);
}

TEST(BeaconArea, IsThatOfAWriterOfBeaconsAndOfNoOther) {
  EXPECT_EQ(BeaconArea({"main/v4"}), "main");
  EXPECT_EQ(BeaconArea({"hall_2/v17"}), "hall_2");
  for (const char* name : {"v4", "world", "fleet", "main/*", "main/v0"}) {
    EXPECT_EQ(BeaconArea({name}), "") << name;
  }
  EXPECT_EQ(BeaconArea({}), "");
}

rtps::GUID_t WriterNumber(std::uint32_t number) {
  rtps::GUID_t guid;
  guid.guidPrefix.value[11] = static_cast<rtps::octet>(number & 0xffU);
  guid.guidPrefix.value[10] = static_cast<rtps::octet>(number >> 8U & 0xffU);
  guid.entityId.value[0] = 1;
  return guid;
}

TEST(WriterNames, KnowsAWriterOnlyAfterUpdate) {
  WriterNames names;
  names.OnWriter(DiscoveryListener::Change::kFound, WriterNumber(1), {"main/v4"});
  EXPECT_EQ(names.Find(WriterNumber(1)), nullptr);
  names.Update();
  ASSERT_NE(names.Find(WriterNumber(1)), nullptr);
  EXPECT_EQ(names.Find(WriterNumber(1))->vehicle, VehicleId{4});
}

TEST(WriterNames, StillNamesAWriterThatJustLeft) {
  WriterNames names;
  names.OnWriter(DiscoveryListener::Change::kFound, WriterNumber(1), {"main/v4"});
  names.OnWriter(DiscoveryListener::Change::kGone, WriterNumber(1), {"main/v4"});
  names.Update();
  ASSERT_NE(names.Find(WriterNumber(1)), nullptr);
  EXPECT_EQ(names.Find(WriterNumber(1))->vehicle, VehicleId{4});
}

TEST(WriterNames, ForgetsWritersThatLeftLongAgoButNotOneThatCameBack) {
  WriterNames names;
  names.OnWriter(DiscoveryListener::Change::kFound, WriterNumber(0), {"main/v4"});
  names.OnWriter(DiscoveryListener::Change::kGone, WriterNumber(0), {"main/v4"});
  names.OnWriter(DiscoveryListener::Change::kFound, WriterNumber(0), {"main/v4"});
  for (std::uint32_t i = 1; i < 3000; ++i) {
    names.OnWriter(DiscoveryListener::Change::kFound, WriterNumber(i), {"main/v5"});
    names.OnWriter(DiscoveryListener::Change::kGone, WriterNumber(i), {"main/v5"});
  }
  for (int turn = 0; turn < 4; ++turn) names.Update();
  EXPECT_EQ(names.Find(WriterNumber(1)), nullptr);
  EXPECT_NE(names.Find(WriterNumber(2999)), nullptr);
  EXPECT_NE(names.Find(WriterNumber(0)), nullptr);
}

// Issue 21, number 11: of 1024 writers that had left the names stayed, 117 KB of a world. What is
// drained after the news needs them for two updates.
TEST(WriterNames, KeepsFewOfThoseThatLeftButAllThatLeftJustNow) {
  constexpr std::uint32_t kFleet = 1000;
  const auto known = [](const WriterNames& names) {
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < kFleet; ++i) count += names.Find(WriterNumber(i)) != nullptr;
    return count;
  };
  WriterNames names;
  for (std::uint32_t i = 0; i < kFleet; ++i) {
    names.OnWriter(DiscoveryListener::Change::kFound, WriterNumber(i), {"main/v5"});
    names.OnWriter(DiscoveryListener::Change::kGone, WriterNumber(i), {"main/v5"});
  }
  for (int turn = 0; turn < 3; ++turn) {
    names.Update();
    EXPECT_EQ(known(names), kFleet) << turn;
  }
  names.Update();
  EXPECT_EQ(known(names), 256U);
}

TEST(WriterNames, KeepsTheOrderOfFirstDiscoveryWhenAWriterComesBack) {
  WriterNames names;
  names.OnWriter(DiscoveryListener::Change::kFound, WriterNumber(1), {"world"});
  names.OnWriter(DiscoveryListener::Change::kFound, WriterNumber(2), {"world"});
  names.OnWriter(DiscoveryListener::Change::kGone, WriterNumber(1), {"world"});
  names.Update();
  names.OnWriter(DiscoveryListener::Change::kFound, WriterNumber(1), {"world"});
  names.Update();
  EXPECT_FALSE(names.Find(WriterNumber(1))->gone);
  EXPECT_LT(names.Find(WriterNumber(1))->found, names.Find(WriterNumber(2))->found);
}

// After a cut longer than the lease all beacons lost in it were counted as overwritten unread.
TEST(WriterNames, CountsAWriterThatIsFoundAgainFromItsNextSample) {
  WriterNames names;
  const auto find = [&] {
    names.OnWriter(DiscoveryListener::Change::kFound, WriterNumber(1), {"main/v4"});
    names.Update();
    return names.Find(WriterNumber(1));
  };
  find()->last_sequence = 41;
  EXPECT_EQ(find()->last_sequence, 41U) << "it was never gone";
  names.OnWriter(DiscoveryListener::Change::kGone, WriterNumber(1), {});
  names.Update();
  EXPECT_EQ(names.Find(WriterNumber(1))->last_sequence, 41U) << "its last samples may yet be taken";
  EXPECT_EQ(find()->last_sequence, 0U);
}

TEST(Identity, DiffersBetweenWritersAndIsNeverZero) {
  std::vector<std::uint64_t> seen;
  for (std::uint32_t i = 0; i < 1000; ++i) seen.push_back(Identity(WriterNumber(i)));
  seen.push_back(Identity(rtps::GUID_t{}));
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(std::adjacent_find(seen.begin(), seen.end()), seen.end());
  EXPECT_NE(seen.front(), 0U);
}

TEST(ResolveInterface, TakesAnAddressANameOrAny) {
  EXPECT_THAT(ResolveInterface("127.0.0.1"), ElementsAre("127.0.0.1"));
  EXPECT_THAT(ResolveInterface("lo"), Contains("127.0.0.1"));
  EXPECT_THAT(ResolveInterface("any"), IsEmpty());
}

TEST(ResolveInterface, NamesTheInterfacesThereAreWhenItKnowsNone) {
  for (const char* wrong : {"no-such-interface", "192.0.2.1", ""}) {
    try {
      ResolveInterface(wrong);
      FAIL() << wrong;
    } catch (const LinkError& error) {
      EXPECT_THAT(error.what(), HasSubstr("lo (127.0.0.1)"));
      EXPECT_THAT(error.what(), HasSubstr(std::string("\"") + wrong + "\""));
    }
  }
}

}  // namespace
}  // namespace giveway::link
