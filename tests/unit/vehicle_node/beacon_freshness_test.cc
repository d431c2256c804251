#include "services/vehicle_node/beacon_freshness.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "tests/support/brain_bench.h"

namespace giveway {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::IsEmpty;
using Item = FreshnessChange;
using Kind = FreshnessKind;

class BeaconFreshnessTest : public testing::Test {
 protected:
  void Hear(std::uint32_t id, milliseconds at, Mode mode = Mode::kCooperative, double x_m = 0) {
    Beacon beacon = test::BeaconOf(id, ++seq_, {});
    beacon.mode = mode;
    beacon.world_from_body.position_world.x = x_m;
    table_->Take(test::Received(beacon, at), self_, options_, &counters_, &trust_);
  }
  std::vector<Item> Update(milliseconds now) {
    freshness_.Update(table_->Peers(), now, self_.tick, options_);
    return {freshness_.Items().begin(), freshness_.Items().end()};
  }

  VehicleOptions options_ = test::DefaultOptions();
  Self self_{VehicleId{1}, test::kEpoch, Tick{100}, {}};
  std::unique_ptr<PeerTable> table_ = std::make_unique<PeerTable>();
  BeaconCounters counters_;
  TrustCounters trust_;
  BeaconFreshnessMonitor freshness_;
  std::uint32_t seq_ = 95;  // the tick it was sent in, too: not old by ticks
};

TEST_F(BeaconFreshnessTest, APeerIsToldOnceWhenItIsHeardAndOnceWhenItIsStale) {
  Hear(2, milliseconds(0));
  Hear(3, milliseconds(0));
  EXPECT_THAT(Update(milliseconds(0)),
              ElementsAre(Item{Kind::kHeard, VehicleId{2}}, Item{Kind::kHeard, VehicleId{3}}));
  Hear(3, milliseconds(100));
  EXPECT_THAT(Update(milliseconds(200)), IsEmpty());
  EXPECT_THAT(Update(milliseconds(201)), ElementsAre(Item{Kind::kStale, VehicleId{2}}));
  EXPECT_THAT(Update(milliseconds(250)), IsEmpty());
  Hear(2, milliseconds(260));
  EXPECT_THAT(Update(milliseconds(260)), ElementsAre(Item{Kind::kHeard, VehicleId{2}}));
}

TEST_F(BeaconFreshnessTest, WhoSaysGoodByeIsNotStale) {
  Hear(2, milliseconds(0));
  Update(milliseconds(0));
  Hear(2, milliseconds(50), Mode::kLeaving);
  EXPECT_THAT(Update(milliseconds(50)), ElementsAre(Item{Kind::kLeft, VehicleId{2}}));
  EXPECT_THAT(Update(milliseconds(900)), IsEmpty());
}

TEST_F(BeaconFreshnessTest, WhoGoesOutOfReachIsNotStale) {
  Hear(2, milliseconds(0), Mode::kCooperative, options_.emission_radius_m - 0.02);
  Update(milliseconds(0));
  Hear(2, milliseconds(50), Mode::kCooperative, options_.emission_radius_m + 0.02);
  EXPECT_THAT(Update(milliseconds(50)), ElementsAre(Item{Kind::kOutOfReach, VehicleId{2}}));
}

TEST_F(BeaconFreshnessTest, WhoIsForgottenWasStale) {
  Hear(2, milliseconds(0));
  Update(milliseconds(0));
  freshness_.Update({}, milliseconds(100), self_.tick, options_);
  EXPECT_THAT(freshness_.Items(), ElementsAre(Item{Kind::kStale, VehicleId{2}}));
}

TEST_F(BeaconFreshnessTest, TheLogNamesKindAndVehicle) {
  EXPECT_EQ(Describe(Item{Kind::kStale, VehicleId{7}}), "beacon_stale: vehicle 7");
}

}  // namespace
}  // namespace giveway
