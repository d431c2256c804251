// Lists of faults as text; that it reads back as the same list is tested in unit/config.
#include "services/faults/schedule_text.h"

#include <gtest/gtest.h>

#include "tests/unit/faults/fault_lists.h"

namespace giveway::faults {
namespace {

TEST(ScheduleText, ALineSaysWhenForHowLongWhoAndWhat) {
  EXPECT_EQ(Line(Of(Kind::kLoss, Vehicle(3), 12.5, 2)),
            "12.5 s for 2 s: vehicle 3: loss probability=0.2");
  EXPECT_EQ(Line(Of(Kind::kKill, Vehicle(3), 12.5, 0)), "12.5 s: vehicle 3: kill");
  EXPECT_EQ(Line(Of(Kind::kOneWayCut, Vehicle(3), 1, 2, {.from = VehicleId{4}})),
            "1 s for 2 s: vehicle 3: one_way_cut from=4");
  EXPECT_EQ(Line(Of(Kind::kQosApply, kAllTarget, 1, 2)),
            "1 s for 2 s: all: qos_apply qos=\"patient_readers\"");
}

TEST(ScheduleText, AFileHasALineAFault) {
  Fault second = Of(Kind::kPause, kWorldTarget, 0.1, 0.25);
  second.nth = 2;
  EXPECT_EQ(
      AsTextproto({Of(Kind::kBurst, Vehicle(3), 12.5, 2), second}),
      "at { name: \"r\" time_s: 12.5 kind: \"burst\" vehicle: 3 for_s: 2 probability: 0.2 "
      "count: 10 }\n"
      "at { name: \"r\" nth: 2 time_s: 0.1 kind: \"pause\" target: \"world\" for_s: 0.25 }\n");
}

TEST(ScheduleText, NumbersAreAsShortAsTheyCanBe) {
  EXPECT_EQ(NumberText(0.1), "0.1");
  EXPECT_EQ(NumberText(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(NumberText(100), "100");
  EXPECT_EQ(NumberText(8e6), "8000000");
  EXPECT_EQ(NumberText(1e-300), "1e-300");
  EXPECT_EQ(SecondsText(0.1 + 0.2), "0.3");
}

}  // namespace
}  // namespace giveway::faults
