#include "services/observer/fleet/frame_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "services/observer/fleet/fleet_json.h"
#include "services/observer/fleet/scene_json.h"

namespace giveway {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;
using ::testing::Not;

ReceivedBeacon BeaconOf(std::uint32_t id) {
  ReceivedBeacon received;
  received.crc_valid = received.name_valid = true;
  received.beacon.vehicle = VehicleId{id};
  received.beacon.world_from_body = {{1.5, -2.25}, 0.5};
  received.beacon.mode = Mode::kCooperative;
  received.beacon.rule = Rule::kGiveWay;
  received.beacon.gives_way_to = VehicleId{9};
  received.beacon.covariance.xx_m2 = 4e-6;
  return received;
}

Truth TruthOf(std::uint32_t id) {
  Truth truth;
  truth.vehicle = VehicleId{id};
  truth.epoch = WorldEpoch{3};
  truth.world_from_body = {{10, 20}, 1};
  truth.forward_m_s = 0.3;
  truth.time_s = 12.5;
  return truth;
}

TEST(FrameJson, AVehicleIsARowOfWholeNumbers) {
  FleetView view;
  view.Fold({.beacons = {BeaconOf(7)}}, seconds(1));
  EXPECT_THAT(
      FrameJson(view, milliseconds(1040)),
      HasSubstr("[7,1500,-2250,500,0,1,0,4,9,9,0,40,-1,1500,-2250,4,0,0,250,-1,-1,0,0,0,1]"));
}

TEST(FrameJson, TheTruthIsWhereTheBodyIsAndTheBeaconWhereItBelievesToBe) {
  FleetView view;
  view.Fold({.truths = {TruthOf(7)}, .beacons = {BeaconOf(7)}}, seconds(1));
  const std::string frame = FrameJson(view, seconds(1));
  EXPECT_THAT(frame, HasSubstr("[7,10000,20000,1000,300,1,"));
  EXPECT_THAT(frame, HasSubstr(",1500,-2250,4,0,0,"));
  EXPECT_THAT(frame, HasSubstr("\"time_ms\":12500"));
}

// Its last beacon made it one for five minutes: others that came by touched it in the report.
TEST(FrameJson, ABodyThatWasTakenAwayIsNotDrawnThere) {
  FleetView view;
  Truth gone = TruthOf(7);
  view.Fold({.truths = {gone}, .statuses = {{.vehicle = gone.vehicle}}, .beacons = {BeaconOf(7)}},
            seconds(1));
  EXPECT_THAT(FrameJson(view, seconds(1)), HasSubstr(",1]]"));
  gone.present = false;
  view.Fold({.truths = {gone}}, seconds(1));
  EXPECT_THAT(FrameJson(view, seconds(1)), HasSubstr("[7,0,0,0,0,1,"));
  EXPECT_THAT(FrameJson(view, seconds(1)), HasSubstr(",0]]"));
}

TEST(FrameJson, WhatIsNotFiniteIsStillJson) {
  FleetView view;
  ReceivedBeacon received = BeaconOf(7);
  received.beacon.world_from_body.position_world = {std::numeric_limits<double>::quiet_NaN(),
                                                    std::numeric_limits<double>::infinity()};
  view.Fold({.beacons = {received}}, seconds(1));
  const std::string frame = FrameJson(view, seconds(1));
  EXPECT_THAT(frame, Not(HasSubstr("nan")));
  EXPECT_THAT(frame, Not(HasSubstr("inf")));
}

TEST(FrameJson, RangesSayEchoClearAndNoDataApart) {
  FleetView view;
  RangeScan scan;
  scan.vehicle = VehicleId{7};
  scan.readings[0] = {.kind = Echo::kEcho, .range_m = 1.25};
  scan.readings[1] = {.kind = Echo::kClear};
  view.Fold({.beacons = {BeaconOf(7)}, .ranges = {scan}}, seconds(1));
  EXPECT_THAT(FrameJson(view, seconds(1)), HasSubstr("\"ranges\":{\"7\":[1250,-1,-2,"));
  EXPECT_THAT(FrameJson(view, seconds(3)), HasSubstr("\"ranges\":{}")) << "old ones are not shown";
}

TEST(FrameJson, CarriesTheLastEvents) {
  FleetView view;
  for (std::uint32_t n = 1; n <= 100; ++n) {
    WorldEvent event;
    event.seq = n;
    event.kind = EventKind::kHalted;
    view.Fold({.events = {event}}, seconds(1));
  }
  const std::string frame = FrameJson(view, seconds(1));
  EXPECT_THAT(frame, HasSubstr("\"seq\":100,"));
  EXPECT_THAT(frame, Not(HasSubstr("\"seq\":76,")));
}

// Regression: one with a wall, an obstacle or a door came without the point that was touched, and
// was on no map.
TEST(FrameJson, AContactHasBothItsPlaces) {
  FleetView view;
  WorldEvent event;
  event.kind = EventKind::kContact;
  event.vehicle = VehicleId{7};
  event.position_world = {1, 2};
  event.other_position_world = {1.5, 2};
  view.Fold({.events = {event}}, seconds(1));
  const auto frame = nlohmann::json::parse(FrameJson(view, seconds(1)));
  const auto& contact = frame["events"].front();
  EXPECT_FALSE(contact.contains("other"));
  EXPECT_EQ(contact["position_world"]["x_m"].get<double>(), 1);
  EXPECT_EQ(contact["other_position_world"]["x_m"].get<double>(), 1.5);
}

TEST(FrameJson, AFrameOf200VehiclesTakesNoMoreThan300kBASecond) {
  FleetView view;
  link::Observed observed;
  for (std::uint32_t id = 1; id <= 200; ++id) {
    observed.truths.push_back(TruthOf(id));
    observed.beacons.push_back(BeaconOf(id));
    RangeScan scan;
    scan.vehicle = VehicleId{id};
    scan.epoch = WorldEpoch{3};
    for (RangeReading& reading : scan.readings) reading = {.kind = Echo::kEcho, .range_m = 2.345};
    observed.ranges.push_back(scan);
  }
  view.Fold(observed, seconds(1));
  constexpr std::size_t kFramesASecond = 5;  // of a fleet above 100
  EXPECT_LE(FrameJson(view, seconds(1)).size() * kFramesASecond, 300'000U);
}

TEST(FleetJson, HasTheNamesOfTheIdl) {
  FleetView view;
  view.Fold({.truths = {TruthOf(7)}, .beacons = {BeaconOf(7)}}, seconds(1));
  const std::string fleet = FleetJson(view, milliseconds(1020));
  EXPECT_THAT(fleet, HasSubstr("\"vehicle\":7,\"hearing\":\"heard\",\"beacon_age_ms\":20"));
  EXPECT_THAT(fleet, HasSubstr("\"gives_way_to\":9"));
  EXPECT_THAT(fleet, HasSubstr("\"world_epoch\":3"));
  const auto vehicle = VehicleJson(view, VehicleId{7}, seconds(1));
  ASSERT_TRUE(vehicle);
  EXPECT_THAT(*vehicle, HasSubstr("\"beacon\":{\"vehicle\":7,"));
  EXPECT_THAT(*vehicle, HasSubstr("\"truth\":{"));
  EXPECT_FALSE(VehicleJson(view, VehicleId{8}, seconds(1)));
}

// The page had no name for the last two: it showed "undefined", and stopped with a filter.
TEST(SceneJson, NamesEveryRule) {
  const auto scene = nlohmann::json::parse(SceneJson({"domain 7", std::nullopt}));
  EXPECT_EQ(scene["rules"].size(), static_cast<std::size_t>(kLastRule) + 1);
  EXPECT_EQ(scene["rules"].back().get<std::string>(), "lost");
}

// Regression: of a scenario with places alone they were those of a usual vehicle.
TEST(SceneJson, EmissionAndSonarAreThoseOfAPlaceWhereThereAreNoVehicles) {
  Scenario scenario;
  VehicleOptions& place = scenario.spawns.emplace_back();
  place.emission_radius_m = 3.5;
  place.profile.sonar_max_range_m = 1.25;
  auto scene = nlohmann::json::parse(SceneJson({"domain 7", scenario}));
  EXPECT_EQ(scene["emission_radius_m"].get<double>(), 3.5);
  EXPECT_EQ(scene["sonar"]["max_range_m"].get<double>(), 1.25);
  scenario.vehicles.emplace_back().emission_radius_m = 4.5;
  scene = nlohmann::json::parse(SceneJson({"domain 7", scenario}));
  EXPECT_EQ(scene["emission_radius_m"].get<double>(), 4.5);
}

// Its cones would all start at the centre, straight ahead.
TEST(SceneJson, WithoutAScenarioTheSonarIsThatOfAUsualRobot) {
  const auto scene = nlohmann::json::parse(SceneJson({"domain 7", std::nullopt}));
  const SensorMount last = PioneerP3dx().sonar.back();
  EXPECT_EQ(scene["sonar"]["mounts"].back(),
            nlohmann::json::array({last.position_body.x, last.position_body.y, last.bearing_rad}));
  EXPECT_NE(last.bearing_rad, 0);
}

// By it a page knows whether what it kept is of the observer that it found again.
TEST(SceneJson, NamesTheObserverOfALivePage) {
  const auto live = nlohmann::json::parse(SceneJson({"domain 7", std::nullopt, "12 of 34"}));
  EXPECT_EQ(live["observer"].get<std::string>(), "12 of 34");
  EXPECT_FALSE(nlohmann::json::parse(SceneJson({"run", std::nullopt})).contains("observer"));
}

TEST(SceneJson, NamesTheColumnsAndWhatStandsInTheScenario) {
  EXPECT_THAT(SceneJson({"domain 7", std::nullopt}), HasSubstr("\"columns\":[\"id\",\"x\","));
  Scenario scenario;
  scenario.name = "yard";
  scenario.walls.push_back({{0, 1}, {2, 3}});
  const std::string scene = SceneJson({"domain 7", scenario});
  EXPECT_THAT(scene, HasSubstr("\"walls\":[[0,1,2,3]]"));
  EXPECT_THAT(scene, HasSubstr("\"scenario\":\"yard\""));
}

}  // namespace
}  // namespace giveway
