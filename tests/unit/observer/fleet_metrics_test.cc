#include "services/observer/fleet_metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/observer/fleet/fleet_json.h"
#include "services/observer/fleet/frame_json.h"

namespace giveway {
namespace {

using std::chrono::seconds;
using ::testing::HasSubstr;
using ::testing::Not;

FleetView ViewOfSeven() {
  VehicleStatus status;
  status.vehicle = VehicleId{7};
  status.decision.mode = Mode::kSensorOnly;
  status.qos.deadline_missed = 4;
  status.beacons.rejected_crc = 2;
  status.packets.packets[static_cast<std::size_t>(PacketDrop::kNone)] = 900;
  status.packets.packets[static_cast<std::size_t>(PacketDrop::kSequenceJump)] = 3;
  status.refused.strangers = 5;
  status.heap_bytes = 7'000'000;
  FigureSummary& age = status.timing.figures[static_cast<std::size_t>(DriveFigure::kBeaconAge)];
  age.count = 2;
  age.newest[0] = 40'000;
  age.newest[1] = 120'000;
  FleetView view;
  view.Fold({.statuses = {status}}, seconds(1));
  return view;
}

TEST(FleetMetrics, EveryVehicleHasItsLabel) {
  const std::string text = FleetMetrics(ViewOfSeven(), {}, seconds(1));
  EXPECT_THAT(text, HasSubstr("giveway_vehicle_deadline_missed_total{vehicle=\"7\"} 4"));
  EXPECT_THAT(text, HasSubstr("giveway_vehicle_mode{vehicle=\"7\",mode=\"sensor_only\"} 1"));
  EXPECT_THAT(text,
              HasSubstr("giveway_vehicle_beacons_rejected_total{vehicle=\"7\",reason=\"crc\"} 2"));
}

TEST(FleetMetrics, HaveTheHeapOfWhoSaysIt) {
  FleetView view = ViewOfSeven();
  view.Fold({.statuses = {{.vehicle = VehicleId{8}}}}, seconds(1));
  const std::string text = FleetMetrics(view, {}, seconds(1));
  EXPECT_THAT(text, HasSubstr("giveway_vehicle_heap_bytes{vehicle=\"7\"} 7000000"));
  EXPECT_THAT(text, Not(HasSubstr("giveway_vehicle_heap_bytes{vehicle=\"8\"}")));
}

TEST(FleetMetrics, SayWhatThePacketFilterDroppedAndWhatSamplesWereRefused) {
  const std::string text = FleetMetrics(ViewOfSeven(), {}, seconds(1));
  EXPECT_THAT(text, HasSubstr("giveway_vehicle_packets_received_total{vehicle=\"7\"} 900"));
  EXPECT_THAT(
      text,
      HasSubstr("giveway_vehicle_packets_dropped_total{vehicle=\"7\",reason=\"sequence_jump\"} 3"));
  EXPECT_THAT(
      text,
      HasSubstr("giveway_vehicle_packets_dropped_total{vehicle=\"7\",reason=\"not_rtps\"} 0"));
  EXPECT_THAT(
      text,
      HasSubstr("giveway_vehicle_samples_refused_total{vehicle=\"7\",reason=\"stranger\"} 5"));
}

TEST(FleetMetrics, BeaconAgesAreAHistogramInSeconds) {
  const std::string text = FleetMetrics(ViewOfSeven(), {}, seconds(1));
  EXPECT_THAT(text, HasSubstr("# TYPE giveway_vehicle_beacon_age_seconds histogram"));
  EXPECT_THAT(text,
              HasSubstr("giveway_vehicle_beacon_age_seconds_bucket{vehicle=\"7\",le=\"0.05\"} 1"));
  EXPECT_THAT(text,
              HasSubstr("giveway_vehicle_beacon_age_seconds_bucket{vehicle=\"7\",le=\"+Inf\"} 2"));
  EXPECT_THAT(text, HasSubstr("giveway_vehicle_beacon_age_seconds_sum{vehicle=\"7\"} 0.16"));
}

TEST(FleetMetrics, OneThatIsSilentIsNoLongerHeard) {
  EXPECT_THAT(FleetMetrics(ViewOfSeven(), {}, seconds(1)),
              HasSubstr("giveway_vehicle_heard{vehicle=\"7\"} 1"));
  const std::string later = FleetMetrics(ViewOfSeven(), {}, seconds(9));
  EXPECT_THAT(later, HasSubstr("giveway_vehicle_heard{vehicle=\"7\"} 0"));
  EXPECT_THAT(later, HasSubstr("giveway_vehicle_silence_seconds{vehicle=\"7\"} 8"));
}

TEST(FleetMetrics, AWorldWithoutVehiclesIsHeard) {
  FleetView view;
  view.Fold({.world = 5}, seconds(1));
  EXPECT_THAT(FleetMetrics(view, {}, seconds(9)), HasSubstr("\ngiveway_observer_world_heard 1\n"));
  view.Fold({}, seconds(10));
  EXPECT_THAT(FleetMetrics(view, {}, seconds(10)), HasSubstr("\ngiveway_observer_world_heard 0\n"));
}

// The page and both JSONs went by the time of its last sample.
TEST(FleetJson, AWorldWithoutVehiclesIsHeardUntilItIsGone) {
  FleetView view;
  view.Fold({.world = 5}, seconds(1));
  EXPECT_THAT(FleetJson(view, seconds(9)), HasSubstr("\"world\":{\"heard\":true"));
  EXPECT_THAT(FrameJson(view, seconds(9)), HasSubstr("\"heard\":true"));
  view.Fold({}, seconds(10));
  EXPECT_THAT(FleetJson(view, seconds(10)), HasSubstr("\"world\":{\"heard\":false"));
  EXPECT_THAT(FrameJson(view, seconds(10)), HasSubstr("\"heard\":false"));
}

TEST(FleetJson, AWorldThatFellSilentIsNoLongerHeard) {
  FleetView view;
  view.Fold({.truths = {{.vehicle = VehicleId{7}, .epoch = WorldEpoch{3}}}, .world = 5},
            seconds(1));
  EXPECT_THAT(FleetJson(view, seconds(2)), HasSubstr("\"world\":{\"heard\":true"));
  EXPECT_THAT(FleetJson(view, seconds(3)),
              HasSubstr("\"world\":{\"heard\":false,\"world_epoch\":3"));
}

// VehicleHalted fired for ever for a vehicle that had crashed in halt.
TEST(FleetMetrics, OfOneThatIsSilentOnlyThatItIsIsServed) {
  const std::string later = FleetMetrics(ViewOfSeven(), {}, seconds(9));
  for (const char* family : {"mode", "rule", "speed_meters_per_second", "deadline_missed_total",
                             "beacons_rejected_total", "heap_bytes", "beacon_age_seconds_count"}) {
    const std::string of_seven = std::string("giveway_vehicle_") + family + "{vehicle=\"7\"";
    EXPECT_THAT(FleetMetrics(ViewOfSeven(), {}, seconds(1)), HasSubstr(of_seven));
    EXPECT_THAT(later, Not(HasSubstr(of_seven)));
  }
}

// The alert VehicleSilent resolves: a restarted process has another id.
TEST(FleetMetrics, OneThatIsGoneForMinutesIsNoLongerServed) {
  FleetView view = ViewOfSeven();
  const SteadyTime late = seconds(2) + FleetSnapshot::kDroppedAfter;
  view.Fold({}, late);
  EXPECT_THAT(FleetMetrics(view, {}, late), Not(HasSubstr("vehicle=\"7\"")));
}

}  // namespace
}  // namespace giveway
