#include "services/fleetctl/stopwatch/stopwatch_words.h"

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
  EXPECT_EQ(WordOf(Line("beacon_stale: vehicle 12")),
            (Word{SteadyTime{1234}, WordKind::kBeaconStale, VehicleId{12}}));
  EXPECT_EQ(WordOf(Line("unmatched: vehicle 2"))->kind, WordKind::kUnmatched);
  EXPECT_EQ(WordOf(Line("matched: vehicle 2"))->kind, WordKind::kMatched);
  EXPECT_EQ(WordOf(Line("drill: the control loop hangs"))->about, kNobody);
}

TEST(StopwatchWords, OtherLinesSayNothing) {
  for (const std::string& line :
       {Line("cruise (cooperative)"), Line("drill: the control loop resumes"),
        Line("unmatched: a vehicle the library does not name"), Line("beacon_stale: vehicle x"),
        std::string("12:00:00 warning vehicle 1: beacon_stale: vehicle 2"), std::string()}) {
    EXPECT_FALSE(WordOf(line)) << line;
  }
}

class PeersHeardTest : public testing::Test {
 protected:
  void Say(VehicleId hearer, WordKind kind, VehicleId about) {
    hearing_.Fold(hearer, {SteadyTime{0}, kind, about});
  }
  void MeetBothWays() {
    for (const auto& [hearer, about] : {std::pair(kOne, kTwo), std::pair(kTwo, kOne)}) {
      Say(hearer, WordKind::kMatched, about);
      Say(hearer, WordKind::kBeaconHeard, about);
    }
  }
  bool AllWell() const { return !hearing_.FirstDeaf(fleet_); }

  const std::vector<VehicleId> fleet_{kOne, kTwo};
  PeersHeard hearing_;
};

TEST_F(PeersHeardTest, NobodyIsHeardBeforeItIsMatchedAndFresh) {
  EXPECT_FALSE(AllWell());
  Say(kOne, WordKind::kMatched, kTwo);
  EXPECT_FALSE(hearing_.Hears(kOne, kTwo));
  MeetBothWays();
  EXPECT_FALSE(hearing_.Hears(kOne, kTwo));  // by two writers
  Say(kOne, WordKind::kUnmatched, kTwo);
  EXPECT_TRUE(AllWell());
}

TEST_F(PeersHeardTest, EachKindOfSilenceIsDeafness) {
  for (const WordKind kind :
       {WordKind::kBeaconStale, WordKind::kBeaconLeft, WordKind::kLivelinessLost}) {
    hearing_ = {};
    MeetBothWays();
    ASSERT_TRUE(AllWell());
    Say(kTwo, kind, kOne);
    EXPECT_EQ(hearing_.FirstDeaf(fleet_), std::pair(kTwo, kOne));
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
  Say(kOne, WordKind::kLivelinessLost, kTwo);
  Say(kOne, WordKind::kUnmatched, kTwo);
  Say(kOne, WordKind::kMatched, kTwo);
  EXPECT_TRUE(AllWell());
}

}  // namespace
}  // namespace giveway::fleetctl
