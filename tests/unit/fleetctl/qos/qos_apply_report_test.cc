// What an operator reads once a set is applied.
#include "services/fleetctl/qos/qos_apply_report.h"

#include <gmock/gmock.h>

namespace giveway::fleetctl {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

ApplyReport ApplyReportOf(ApplyVerdict verdict) {
  return {.profile = "lossy_radio.xml",
          .vehicles = {{.vehicle = VehicleId{1}}, {.vehicle = VehicleId{2}}, {}},
          .verdict = verdict};
}

// A vehicle that crashed came back with the set it was deployed with, matched no other, and stood
// as an obstacle: nothing had said that the applied one does not outlive its process.
TEST(QosApplyReport, SaysUntilWhenAnAppliedSetHoldsAndWhatToSet) {
  const std::string text = LineOf(ApplyReportOf(ApplyVerdict::kApplied));
  EXPECT_THAT(text, HasSubstr("until it is started from outside"));
  EXPECT_THAT(text, HasSubstr("set its --qos or GIVEWAY_QOS to lossy_radio.xml, too\n"));
  // Last, where a soak that gave the order reads it.
  EXPECT_THAT(text, ::testing::EndsWith("lossy_radio.xml in effect on 2 vehicles and the world\n"));
}

TEST(QosApplyReport, SaysNothingOfItWhereNothingWasApplied) {
  EXPECT_THAT(LineOf(ApplyReportOf(ApplyVerdict::kDryRun)), Not(HasSubstr("GIVEWAY_QOS")));
}

// In a fleet above 32 code sets leases, whatever the file says: each such order ended "not seen".
TEST(QosApplyReport, ExpectsOfCodeWhatItDecidedBefore) {
  const std::string profile = "giveway_participant";
  const auto answer = [&](std::int64_t lease, std::int64_t depth) {
    AdminAnswer one;
    one.live = {{profile, "participant_lease", lease}, {profile, "depth", depth}};
    return one;
  };
  AppliedTo applied;
  applied.changes = {{.profile = profile, .what = "participant_lease", .number = 10, .before = 20},
                     {.profile = profile, .what = "depth", .number = 8, .before = 4}};
  const auto seen = [&](const AdminAnswer& before, const AdminAnswer& now) {
    AppliedTo held = applied;
    HoldAgainstChanges(before, now, &held);
    EXPECT_EQ(held.checked, 2U);
    return held.seen;
  };
  EXPECT_EQ(seen(answer(20, 4), answer(10, 8)), 2U);
  EXPECT_EQ(seen(answer(20, 4), answer(20, 4)), 0U) << "both were the file's, and are not now";
  EXPECT_EQ(seen(answer(33, 4), answer(33, 8)), 2U) << "the lease is code's";
  EXPECT_EQ(seen(answer(33, 4), answer(20, 8)), 1U);
}

}  // namespace
}  // namespace giveway::fleetctl
