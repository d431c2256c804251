// Until when a refusal is awaited. The processes themselves are in tests/system/soak.sh.
#include "services/fleetctl/soak/host_faults/second_claim.h"

#include <gtest/gtest.h>

namespace giveway::fleetctl {
namespace {

using std::chrono::seconds;

constexpr const char* kRefusal =
    R"({"level":"warning","text":"the world lets it wait: vehicle 2 is taken by another session"})";

TEST(SecondClaim, IsRefusedByTheWordsOfTheWorldAlone) {
  SecondClaim claim;
  claim.NoteLine(R"({"level":"info","text":"matched: vehicle 2"})");
  EXPECT_FALSE(claim.IsRefused());
  claim.NoteLine(kRefusal);
  claim.NoteLine("");
  EXPECT_TRUE(claim.IsRefused());
}

TEST(SecondClaim, LastsAsLongAsTheFaultHoweverSoonItIsRefused) {
  SecondClaim claim;
  claim.NoteLine(kRefusal);
  EXPECT_FALSE(claim.IsOver(seconds(100)));
  claim.NoteFaultOver(seconds(100));
  EXPECT_TRUE(claim.IsOver(seconds(100)));
}

TEST(SecondClaim, OfAShortFaultIsAwaitedALittleLonger) {
  SecondClaim claim;
  claim.NoteFaultOver(seconds(100));
  EXPECT_FALSE(claim.IsOver(seconds(107)));
  claim.NoteWorldAway();  // too late to excuse it
  EXPECT_FALSE(claim.IsOver(seconds(107)));
  EXPECT_TRUE(claim.IsOver(seconds(108)));
}

// Else its process could get the id of a vehicle that the other fault kills.
TEST(SecondClaim, PastItsFaultIsCutShortByAnotherOfItsVehicleOrWorld) {
  using What = faults::Target::What;
  const faults::Target own{What::kVehicle, VehicleId{2}};
  SecondClaim claim;
  EXPECT_FALSE(claim.IsCutShort(own, own)) << "its own fault lasts";
  claim.NoteFaultOver(seconds(100));
  EXPECT_TRUE(claim.IsCutShort(own, own));
  EXPECT_TRUE(claim.IsCutShort(own, {What::kWorld}));
  EXPECT_TRUE(claim.IsCutShort(own, {What::kAll}));
  EXPECT_FALSE(claim.IsCutShort(own, {What::kVehicle, VehicleId{3}}));
  EXPECT_FALSE(claim.IsCutShort(own, {What::kDiscoveryServer}));
  claim.NoteLine(kRefusal);
  EXPECT_FALSE(claim.IsCutShort(own, own)) << "it was answered";
}

TEST(SecondClaim, IsNotAwaitedOfAWorldThatWasAway) {
  SecondClaim claim;
  claim.NoteWorldAway();
  EXPECT_TRUE(claim.WorldWasAway());
  EXPECT_FALSE(claim.IsOver(seconds(99)));
  claim.NoteFaultOver(seconds(100));
  EXPECT_TRUE(claim.IsOver(seconds(100)));
}

}  // namespace
}  // namespace giveway::fleetctl
