// A recording is read as far as it is intact, whatever was done to the file.
#include "services/recording/recording_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "tests/support/recorded_crossing.h"

namespace giveway {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

struct Reading {
  std::uint32_t steps = 0;
  bool has_life = false;
  bool cut_off = false;
  bool complete = false;
  std::string complaint;
};

Reading Read(const std::string& bytes) {
  std::istringstream stream(bytes);
  RecordingFile file(&stream);
  Reading reading;
  while (const auto record = file.Next()) {
    if (std::holds_alternative<RecordedStep>(*record)) ++reading.steps;
  }
  reading.has_life = file.Life().has_value();
  reading.cut_off = file.WasCutOff();
  reading.complete = file.End().has_value();
  reading.complaint = file.Complaint();
  return reading;
}

TEST(RecordingFile, ReadsEveryStepToTheEnd) {
  const Reading reading = Read(test::FileOf(test::RecordedCrossing(5)));
  EXPECT_EQ(reading.steps, 5U);
  EXPECT_TRUE(reading.complete);
  EXPECT_FALSE(reading.cut_off);
  EXPECT_THAT(reading.complaint, IsEmpty());
}

// As kill -9 leaves it, at any byte.
TEST(RecordingFile, ACutFileIsReadUpToItsLastWholeRecord) {
  const std::vector<Record> records = test::RecordedCrossing(3);
  const std::string whole = test::FileOf(records);
  std::vector<std::size_t> ends;  // of the mark and of each record
  for (std::size_t i = 0; i <= records.size(); ++i) {
    ends.push_back(
        test::FileOf({records.begin(), records.begin() + static_cast<std::ptrdiff_t>(i)}).size());
  }
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const Reading reading = Read(whole.substr(0, length));
    EXPECT_FALSE(reading.complete) << length;
    if (length < ends[1]) {
      EXPECT_FALSE(reading.has_life) << length;
      EXPECT_FALSE(reading.complaint.empty()) << length;
      continue;
    }
    std::uint32_t steps = 0;
    while (steps < 3 && length >= ends[steps + 2]) ++steps;
    EXPECT_EQ(reading.steps, steps) << length;
    EXPECT_TRUE(reading.cut_off) << length;
    EXPECT_THAT(reading.complaint, IsEmpty()) << length;
  }
}

TEST(RecordingFile, EverySingleFlippedBitIsFoundAndNotTakenForACut) {
  const std::string whole = test::FileOf(test::RecordedCrossing(2));
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string spoilt = whole;
    spoilt[bit / 8] = static_cast<char>(spoilt[bit / 8] ^ (1 << bit % 8));
    const Reading reading = Read(spoilt);
    ASSERT_FALSE(reading.complaint.empty()) << "bit " << bit;
    ASSERT_FALSE(reading.cut_off) << "bit " << bit;
  }
}

TEST(RecordingFile, WhatIsNoRecordingIsSaidInWords) {
  EXPECT_THAT(Read("").complaint, HasSubstr("is empty: its disk was full"));
  EXPECT_THAT(Read("giveway-rec").complaint, HasSubstr("cut off in its first line"));
  EXPECT_THAT(Read("giveway-recording-4\n").complaint, HasSubstr("format 4"));
  EXPECT_THAT(Read("giveway-recording-123456789\n").complaint, HasSubstr("no recording"));
  EXPECT_THAT(Read("giveway-recording-x\n").complaint, HasSubstr("no recording"));
  EXPECT_THAT(Read(std::string(100000, '\0')).complaint, HasSubstr("no recording"));
  EXPECT_THAT(Read(std::string(kRecordingMark)).complaint, HasSubstr("no step"));
}

TEST(RecordingFile, RecordsOutOfPlaceAreRefused) {
  std::vector<Record> records = test::RecordedCrossing(2);
  EXPECT_THAT(Read(test::FileOf({records[1]})).complaint, HasSubstr("does not begin"));
  EXPECT_THAT(Read(test::FileOf({records[0], records[0]})).complaint, HasSubstr("second vehicle"));
  EXPECT_THAT(Read(test::FileOf(records) + "x").complaint, HasSubstr("behind its end"));
  RecordedLife life = std::get<RecordedLife>(records[0]);
  life.boot_epoch = 0;
  EXPECT_THAT(Read(test::FileOf({life})).complaint, HasSubstr("boot epoch"));
  life = std::get<RecordedLife>(records[0]);
  life.options.tick_period = Nanoseconds{0};
  EXPECT_THAT(Read(test::FileOf({life})).complaint, HasSubstr("no tick"));
  EXPECT_THAT(Read(test::FileOf({records[0], RecordedReseat{test::DefaultOptions(9)}})).complaint,
              HasSubstr("another vehicle's"));
}

TEST(RecordingFile, ALengthBeyondAllMeasureIsNotBelieved) {
  std::string frame = Framed("abc");
  EXPECT_DEATH(Framed(std::string(kMostPayloadBytes + 1, 'x')), "check failed");
  std::istringstream stream(frame);
  std::string payload;
  EXPECT_EQ(ReadFrame(stream, &payload), FrameEnd::kFrame);
  EXPECT_EQ(payload, "abc");
  EXPECT_EQ(ReadFrame(stream, &payload), FrameEnd::kEnd);
}

// The sums are CRC-32C: a reader in another language finds the test vector here.
TEST(RecordingFile, AFrameIsLengthSumSumAndPayload) {
  EXPECT_EQ(Framed("123456789").substr(0, 8), std::string("\x09\0\0\0\x83\x92\x06\xe3", 8));
}

}  // namespace
}  // namespace giveway
