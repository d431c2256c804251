#include "services/fleetctl/stopwatch/stopwatch_log_events.h"

#include <gtest/gtest.h>

#include <vector>

namespace giveway::fleetctl {
namespace {

constexpr VehicleId kOne{1};
constexpr VehicleId kTwo{2};

std::string Line(const std::string& text) {
  return R"({"time":"2026-01-02T03:04:05.678Z","steady_ns":1234,"level":"info",)"
         R"("process":"vehicle 1","text":")" +
         text + "\"}";
}

TEST(StopwatchWords, ALineSaysWhenWhatAndAboutWhom) {
  EXPECT_EQ(LogEventOf(Line("beacon_stale: vehicle 12")),
            (LogEvent{SteadyTime{1234}, LogEventKind::kBeaconStale, VehicleId{12}}));
  EXPECT_EQ(LogEventOf(Line("unmatched: vehicle 2"))->kind, LogEventKind::kUnmatched);
  EXPECT_EQ(LogEventOf(Line("matched: vehicle 2"))->kind, LogEventKind::kMatched);
  EXPECT_EQ(LogEventOf(Line("drill: the control loop hangs"))->about, kNoVehicle);
}

TEST(StopwatchWords, OtherLinesSayNothing) {
  for (const std::string& line :
       {Line("cruise (cooperative)"), Line("drill: the control loop resumes"),
        Line("unmatched: a vehicle the library does not name"), Line("beacon_stale: vehicle x"),
        std::string("12:00:00 warning vehicle 1: beacon_stale: vehicle 2"), std::string()}) {
    EXPECT_FALSE(LogEventOf(line)) << line;
  }
}

class PeersHeardTest : public testing::Test {
 protected:
  void Report(VehicleId hearer, LogEventKind kind, VehicleId about) {
    hearing_.Fold(hearer, {SteadyTime{0}, kind, about});
  }
  void MeetBothWays() {
    for (const auto& [hearer, about] : {std::pair(kOne, kTwo), std::pair(kTwo, kOne)}) {
      Report(hearer, LogEventKind::kMatched, about);
      Report(hearer, LogEventKind::kBeaconHeard, about);
    }
  }
  bool AllWell() const { return !hearing_.FirstUnheard(fleet_); }

  const std::vector<VehicleId> fleet_{kOne, kTwo};
  PeersHeard hearing_;
};

TEST_F(PeersHeardTest, NobodyIsHeardBeforeItIsMatchedAndFresh) {
  EXPECT_FALSE(AllWell());
  Report(kOne, LogEventKind::kMatched, kTwo);
  EXPECT_FALSE(hearing_.Hears(kOne, kTwo));
  MeetBothWays();
  EXPECT_FALSE(hearing_.Hears(kOne, kTwo));  // by two writers
  Report(kOne, LogEventKind::kUnmatched, kTwo);
  EXPECT_TRUE(AllWell());
}

TEST_F(PeersHeardTest, EachKindOfSilenceIsDeafness) {
  for (const LogEventKind kind :
       {LogEventKind::kBeaconStale, LogEventKind::kBeaconLeft, LogEventKind::kLivelinessLost}) {
    hearing_ = {};
    MeetBothWays();
    ASSERT_TRUE(AllWell());
    Report(kTwo, kind, kOne);
    EXPECT_EQ(hearing_.FirstUnheard(fleet_), std::pair(kTwo, kOne));
  }
}

TEST_F(PeersHeardTest, ANewLifeHasHeardNobodyButIsHeardAsBefore) {
  MeetBothWays();
  hearing_.Restart(kOne);
  EXPECT_FALSE(hearing_.Hears(kOne, kTwo));
  EXPECT_TRUE(hearing_.Hears(kTwo, kOne));
}

TEST_F(PeersHeardTest, ANewWriterBeginsAlive) {
  MeetBothWays();
  Report(kOne, LogEventKind::kLivelinessLost, kTwo);
  Report(kOne, LogEventKind::kUnmatched, kTwo);
  Report(kOne, LogEventKind::kMatched, kTwo);
  EXPECT_TRUE(AllWell());
}

}  // namespace
}  // namespace giveway::fleetctl
