// Which candidates are worth having.
#include "services/fleetctl/tune/tune_front.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/fleetctl/tune/tune_report.h"

namespace giveway::fleetctl {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// So many alarms in one vehicle-hour.
TuneFigures Figures(std::uint32_t alarms, double detection_ms) {
  TuneFigures figures;
  figures.trials = 1;
  figures.vehicle_hours = 1;
  figures.alarms.deadline = alarms;
  figures.alarms_per_hour = alarms;
  figures.detections = 10;
  figures.detection_ms = detection_ms;
  return figures;
}

TEST(TuneFront, WhoIsBeatenInBothIsNotOnIt) {
  EXPECT_THAT(ParetoFront({Figures(100, 200), Figures(50, 250), Figures(200, 150),
                           Figures(120, 260), Figures(90, 200)}),
              ElementsAre(2, 4, 1));
}

TEST(TuneFront, DetectionTimesThatCannotBeToldApartBeatNobody) {
  EXPECT_THAT(ParetoFront({Figures(100, 200), Figures(50, 204)}), ElementsAre(1));
}

TEST(TuneFront, WhoMissedADeathIsLast) {
  TuneFigures blind = Figures(1, 10);
  blind.undetected = 1;
  EXPECT_THAT(ParetoFront({Figures(100, 200), blind}), ElementsAre(0, 1));
  EXPECT_EQ(Recommended({Figures(100, 200), blind}, 0), 0U);
  EXPECT_EQ(Recommended({blind, blind}, 0), 0U);
  EXPECT_FALSE(NoticesNoLater(blind, blind));
  EXPECT_FALSE(NoticesNoLater(blind, Figures(100, 200)));
}

TEST(TuneFront, TheRankingGoesFrontByFront) {
  EXPECT_THAT(Ranking({Figures(100, 200), Figures(90, 190), Figures(10, 400), Figures(200, 500)}),
              ElementsAre(2, 1, 0, 3));
}

TEST(TuneFront, FewerIsBeyondChance) {
  EXPECT_TRUE(HasFewerAlarms(Figures(50, 200), Figures(100, 200)));
  EXPECT_FALSE(HasFewerAlarms(Figures(90, 200), Figures(100, 200)));
  EXPECT_FALSE(HasFewerAlarms(Figures(0, 200), Figures(2, 200)));
  EXPECT_FALSE(HasFewerAlarms(Figures(100, 200), Figures(50, 200)));
  TuneFigures scattered = Figures(50, 200);
  scattered.dispersion = 16;
  EXPECT_FALSE(HasFewerAlarms(scattered, Figures(100, 200)));
}

TEST(TuneFront, LaterIsBeyondChance) {
  TuneFigures unsure = Figures(10, 214);
  EXPECT_FALSE(NoticesNoLater(unsure, Figures(10, 200)));
  unsure.detection_error_ms = 8;
  EXPECT_TRUE(NoticesNoLater(unsure, Figures(10, 200)));
  unsure.detection_error_ms = 50;  // nothing is known, and that excuses no whole turn
  unsure.detection_ms = 225;
  EXPECT_FALSE(NoticesNoLater(unsure, Figures(10, 200)));
  EXPECT_TRUE(NoticesNoLater(Figures(10, 150), Figures(10, 200)));
}

TEST(TuneFront, RecommendedIsTheFirstToNoticeOfThoseWithFewerAlarms) {
  EXPECT_EQ(Recommended({Figures(100, 200), Figures(20, 200), Figures(40, 150)}, 0), 2U);
}

TEST(TuneFront, OfThoseThatNoticeAlikeTheOneWithTheFewestAlarms) {
  EXPECT_EQ(Recommended({Figures(100, 200), Figures(20, 203), Figures(40, 199)}, 0), 1U);
}

TEST(TuneFront, ALaterNoticeIsNotRecommendedWhereAnEqualOneIsBetter) {
  EXPECT_EQ(Recommended({Figures(100, 200), Figures(50, 200), Figures(1, 250)}, 0), 1U);
}

TEST(TuneFront, TiesGoToTheCheaper) {
  TuneFigures dear = Figures(20, 200);
  dear.heard_bytes_s = 5000;
  TuneFigures cheap = Figures(20, 200);
  cheap.heard_bytes_s = 4000;
  EXPECT_EQ(Recommended({Figures(100, 200), dear, cheap}, 0), 2U);
}

TEST(TuneFront, WhereNoneIsBetterTheFewestAlarmsOfAll) {
  EXPECT_EQ(Recommended({Figures(100, 200), Figures(10, 260), Figures(300, 150)}, 0), 1U);
  EXPECT_EQ(Recommended({Figures(10, 200), Figures(100, 200)}, 0), 0U);
}

TEST(TuneFront, AResultThatWasNotVerifiedSaysSo) {
  TuneResult result;
  result.candidates = {{.candidate = {"base", {}}, .figures = Figures(100, 200)},
                       {.candidate = {"d190", {}}, .figures = Figures(20, 200)},
                       {.candidate = {"bad", {}}, .trouble = "refused"}};
  ChooseRecommended(&result);
  EXPECT_EQ(result.recommended, 1U);
  EXPECT_THAT(result.front, ElementsAre(1));
  EXPECT_FALSE(result.IsBetter());
  EXPECT_THAT(ToText(result), HasSubstr("not verified"));
  result.verified = Verification{Figures(100, 200), Figures(20, 200), true, true};
  EXPECT_TRUE(result.IsBetter());
  EXPECT_THAT(ToText(result), HasSubstr("Verified: fewer"));
  EXPECT_THAT(ToText(result), HasSubstr("not measured: refused"));
  result.verified->no_later = false;
  EXPECT_THAT(ToText(result), HasSubstr("noticed later"));
}

}  // namespace
}  // namespace giveway::fleetctl
