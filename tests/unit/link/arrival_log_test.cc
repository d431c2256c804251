#include "services/link/inbox/arrival_log.h"

#include <gtest/gtest.h>

#include <array>

namespace giveway::link {
namespace {

constexpr std::uint64_t kWriter = 5;

void Turns(std::uint64_t turns, ArrivalLog* log) {
  for (std::uint64_t turn = 0; turn < turns; ++turn) log->NoteLeft({});
}

TEST(ArrivalLog, CountsFromTheFirstThatArrives) {
  ArrivalLog log;
  log.Note(kWriter, 40, true);
  const BeaconArrival expected{.sequence = 40, .arrived = 1};
  EXPECT_EQ(log.At(kWriter, 40), expected);
}

TEST(ArrivalLog, CountsGapsAsMissingAndWhatAFilterKeptOut) {
  ArrivalLog log;
  log.Note(kWriter, 1, true);
  log.Note(kWriter, 5, false);
  log.Note(kWriter, 7, true);
  const BeaconArrival expected{.sequence = 7, .arrived = 3, .missing = 4, .filtered = 1};
  EXPECT_EQ(log.At(kWriter, 7), expected);
  EXPECT_EQ(log.At(kWriter, 1)->missing, 0U) << "as it was then";
}

TEST(ArrivalLog, NeitherADuplicateNorOneThatIsLateCounts) {
  ArrivalLog log;
  log.Note(kWriter, 1, true);
  log.Note(kWriter, 3, true);
  log.Note(kWriter, 3, true);
  log.Note(kWriter, 2, true);
  log.Note(kWriter, 4, true);
  const BeaconArrival expected{.sequence = 4, .arrived = 3, .missing = 1};
  EXPECT_EQ(log.At(kWriter, 4), expected);
}

TEST(ArrivalLog, CountsEachWriterByItself) {
  ArrivalLog log;
  log.Note(1, 10, true);
  log.Note(2, 20, true);
  log.Note(1, 12, true);
  EXPECT_EQ(log.At(1, 12)->missing, 1U);
  EXPECT_EQ(log.At(2, 20)->missing, 0U);
}

TEST(ArrivalLog, KeepsTheNewestOfABoundedNumberOfWriters) {
  ArrivalLog log;
  for (std::uint64_t sequence = 1; sequence <= ArrivalLog::kKept + 1; ++sequence) {
    log.Note(kWriter, sequence, true);
  }
  EXPECT_FALSE(log.At(kWriter, 1));
  EXPECT_TRUE(log.At(kWriter, 2));
  EXPECT_FALSE(log.At(kWriter, 0));
  EXPECT_FALSE(log.At(kWriter + 1, 2));
  for (std::uint64_t writer = 100; writer < 100 + ArrivalLog::kMostWriters; ++writer) {
    log.Note(writer, 1, true);
  }
  EXPECT_FALSE(log.At(kWriter, 2)) << "the oldest is forgotten";
  EXPECT_TRUE(log.At(100, 1));
}

TEST(ArrivalLog, ForgetsAWriterThatLeftButOnlyOnceItsLastSamplesWereTaken) {
  ArrivalLog log;
  log.Note(kWriter, 1, true);
  log.NoteLeft(std::array{kWriter});
  Turns(ArrivalLog::kTurnsToForget - 1, &log);
  EXPECT_TRUE(log.At(kWriter, 1));
  Turns(1, &log);
  EXPECT_FALSE(log.At(kWriter, 1));
}

TEST(ArrivalLog, KeepsAWriterThatSpeaksAgainAfterItLeft) {
  ArrivalLog log;
  log.Note(kWriter, 1, true);
  log.NoteLeft(std::array{kWriter});
  log.Note(kWriter, 2, true);
  Turns(ArrivalLog::kTurnsToForget + 1, &log);
  EXPECT_TRUE(log.At(kWriter, 2));
}

TEST(ArrivalLog, AForgottenWriterFreesItsPlace) {
  ArrivalLog log;
  log.Note(1, 1, true);
  for (std::uint64_t writer = 2; writer <= ArrivalLog::kMostWriters; ++writer) {
    log.Note(writer, 1, true);
  }
  log.NoteLeft(std::array<std::uint64_t, 1>{2});
  Turns(ArrivalLog::kTurnsToForget, &log);
  log.Note(ArrivalLog::kMostWriters + 1, 1, true);
  EXPECT_TRUE(log.At(1, 1)) << "the oldest may stay";
}

}  // namespace
}  // namespace giveway::link
