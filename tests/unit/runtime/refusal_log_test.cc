// Each writer's fault is logged once, and a flood of them fills no disk.
#include "services/runtime/refusal_log.h"

#include <gmock/gmock.h>

namespace giveway {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;
using testing::StartsWith;

Refusal RefusalOf(std::uint64_t writer, const char* field) {
  return {.sample = "beacon",
          .vehicle = VehicleId{5},
          .writer = writer,
          .counter = "rejected_out_of_range",
          .field = field,
          .why = std::string(field) + " is 7, must be 0 to 2.5"};
}

TEST(RefusalLog, SaysEachFaultOfAWriterOnce) {
  RefusalLog log;
  const auto line = log.Note(RefusalOf(1, "cruise_m_s"), seconds(1));
  ASSERT_TRUE(line);
  EXPECT_THAT(*line,
              StartsWith("refuses a beacon of vehicle 5: cruise_m_s is 7, must be 0 to 2.5"));
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(log.Note(RefusalOf(1, "cruise_m_s"), seconds(1 + i)));
  EXPECT_TRUE(log.Note(RefusalOf(1, "axle_m"), seconds(200)));
  EXPECT_TRUE(log.Note(RefusalOf(2, "cruise_m_s"), seconds(200)));
}

TEST(RefusalLog, NamesWhatIsRefusedInEnglish) {
  EXPECT_THAT(Describe(Refusal{.sample = "answer", .why = "x"}), StartsWith("refuses an answer: "));
  EXPECT_THAT(Describe(Refusal{.sample = "beacon", .why = "x"}), StartsWith("refuses a beacon: "));
}

TEST(RefusalLog, DoesNotSpeakOfWhatPasses) {
  RefusalLog log;
  Refusal refusal = RefusalOf(1, "world_epoch");
  refusal.passing = true;
  int lines = 0;
  for (int i = 0; i < 19; ++i) lines += log.Note(refusal, seconds(1)) ? 1 : 0;
  EXPECT_EQ(lines, 0);
  for (int i = 0; i < 100; ++i) lines += log.Note(refusal, seconds(2)) ? 1 : 0;
  EXPECT_EQ(lines, 1);
}

TEST(RefusalLog, OfAFloodOfWritersLogsFewLinesAndSaysThatItLeftSomeOut) {
  RefusalLog log;
  int lines = 0;
  for (std::uint64_t writer = 1; writer <= 10'000; ++writer) {
    lines += log.Note(RefusalOf(writer, "cruise_m_s"), seconds(1)) ? 1 : 0;
  }
  EXPECT_LE(lines, 20);
  const auto later = log.Note(RefusalOf(20'000, "cruise_m_s"), seconds(11));
  ASSERT_TRUE(later);
  EXPECT_THAT(*later, HasSubstr("(9980 such lines were left out)"));
}

}  // namespace
}  // namespace giveway
