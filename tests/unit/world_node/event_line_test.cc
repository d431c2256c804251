// What the world's log says of an event: who, and what.
#include "services/world_node/event_line.h"

#include <gtest/gtest.h>

namespace giveway {
namespace {

constexpr VehicleId kThree{3};

TEST(EventLine, OfAContactSaysWhatWasTouched) {
  WorldEvent event{.kind = EventKind::kContact, .vehicle = kThree, .other = VehicleId{4}};
  EXPECT_EQ(LogLine(event), "contact: vehicle 3 touched vehicle 4");
  event.other = kNoVehicle;
  event.text = "wall";
  EXPECT_EQ(LogLine(event), "contact: vehicle 3 touched a wall");
  event.text = "obstacle";
  EXPECT_EQ(LogLine(event), "contact: vehicle 3 touched an obstacle");
}

TEST(EventLine, OfAPlannedFaultSaysWhatItConcerns) {
  EXPECT_EQ(LogLine({.kind = EventKind::kFaultDue, .vehicle = kThree, .text = "kill"}),
            "fault due: kill of vehicle 3");
  EXPECT_EQ(LogLine({.kind = EventKind::kFaultDue, .value = 7, .text = "signal_dark"}),
            "fault due: signal_dark of signal 7");
}

TEST(EventLine, OfAScheduledFaultSaysWhatItConcerns) {
  EXPECT_EQ(
      LogLine({.kind = EventKind::kFaultBegan, .vehicle = kThree, .text = "sonar_off 1 of blind"}),
      "fault starts: sonar_off 1 of blind, of vehicle 3");
  EXPECT_EQ(LogLine({.kind = EventKind::kFaultOver, .text = "sonar_off 1 of blind"}),
            "fault is over: sonar_off 1 of blind, of all vehicles");
}

TEST(EventLine, OfWhatOnlyObserversNeedIsEmpty) {
  EXPECT_EQ(LogLine({.kind = EventKind::kHalted, .vehicle = kThree}), "");
}

}  // namespace
}  // namespace giveway
