#include "services/fleetctl/survey/local_fleets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace giveway::fleetctl {
namespace {

using testing::HasSubstr;

constexpr std::uint64_t kHere = 100;

FleetMember VehicleMember(int pid, std::uint32_t id, std::uint32_t domain,
                          const std::string& interface = "127.0.0.1",
                          std::uint64_t network = kHere) {
  return {pid, false, VehicleId{id}, domain, interface, network};
}

FleetMember WorldMember(int pid, std::uint32_t domain) {
  return {pid, true, kNoVehicle, domain, "127.0.0.1", kHere};
}

TEST(LocalFleets, AreGroupedByDomainInterfaceAndNamespace) {
  const auto fleets =
      LocalFleets({VehicleMember(11, 2, 7), VehicleMember(12, 1, 7, "lo"), WorldMember(10, 7),
                   VehicleMember(13, 1, 8), VehicleMember(14, 1, 7, "eth0"),
                   VehicleMember(15, 1, 7, "127.0.0.1", 200)});
  ASSERT_EQ(fleets.size(), 4U);
  EXPECT_EQ(fleets[0].domain, 7U);
  EXPECT_EQ(fleets[0].worlds, std::vector<int>{10});
  ASSERT_EQ(fleets[0].vehicles.size(), 2U);
  EXPECT_EQ(fleets[0].vehicles[0].id, VehicleId{1});  // by id, not by process
}

TEST(LocalFleets, TheOnlyOneNeedsNoDomain) {
  const auto chosen =
      ChooseFleet(LocalFleets({WorldMember(10, 7), VehicleMember(11, 1, 7)}), kHere);
  ASSERT_TRUE(chosen.fleet);
  EXPECT_EQ(chosen.fleet->domain, 7U);
}

TEST(LocalFleets, OneInAnotherNamespaceIsNotChosen) {
  const std::vector<FleetMember> members = {VehicleMember(11, 1, 7),
                                            VehicleMember(12, 1, 8, "127.0.0.1", 200)};
  EXPECT_EQ(ChooseFleet(LocalFleets(members), kHere).fleet->domain, 7U);
  EXPECT_FALSE(ChooseFleet(LocalFleets(members), 300).fleet);
}

TEST(LocalFleets, OfSeveralNoneIsChosenAndAllAreNamed) {
  const auto chosen = ChooseFleet(
      LocalFleets({VehicleMember(11, 1, 7), VehicleMember(12, 1, 8), VehicleMember(13, 1, 9)}),
      kHere);
  EXPECT_FALSE(chosen.fleet);
  EXPECT_THAT(chosen.why, HasSubstr("domains 7 (interface 127.0.0.1, 1 vehicles), 8"));
  EXPECT_THAT(chosen.why, HasSubstr("9 (interface"));
}

TEST(LocalFleets, WithoutAnyItIsSaid) {
  EXPECT_THAT(ChooseFleet({}, kHere).why, HasSubstr("no fleet runs on this machine"));
}

}  // namespace
}  // namespace giveway::fleetctl
