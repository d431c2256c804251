// The recorder never waits, and reports what it could not write.
#include "services/recording/recorder.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "services/recording/recording_file.h"
#include "services/runtime/slot_ring.h"
#include "tests/support/full_disk.h"
#include "tests/support/recorded_crossing.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway {
namespace {

using testing::ElementsAre;

std::string BytesOf(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::uint32_t StepsIn(const std::string& bytes, std::optional<RecordedEnd>* end = nullptr) {
  std::istringstream stream(bytes);
  RecordingFile file(&stream);
  std::uint32_t steps = 0;
  while (file.Next()) ++steps;
  EXPECT_EQ(file.Complaint(), "");
  if (end != nullptr) *end = file.End();
  return steps;
}

// Feeds a recorder as a loop would.
void Drive(const std::vector<Record>& records, Recorder* recorder) {
  for (const Record& record : records) {
    if (const auto* life = std::get_if<RecordedLife>(&record)) {
      recorder->Begin(life->options, life->boot_epoch);
    } else if (const auto* step = std::get_if<RecordedStep>(&record)) {
      recorder->Step(step->AsInputs(), step->outputs, step->hash);
    }
  }
}

TEST(Recorder, WritesWhatItWasGivenInOrder) {
  const TempFolder folder;
  const std::string file = folder.Path() + "/tape";
  const std::vector<Record> records = test::RecordedCrossing(60);  // fewer than the queue holds
  {
    Recorder recorder(file);
    Drive(records, &recorder);
    const RecorderTally tally = recorder.Close();
    EXPECT_EQ(tally.steps, 60U);
    EXPECT_EQ(tally.lost, 0U);
  }
  std::vector<Record> expected = records;
  std::get<RecordedLife>(expected[0]).recorded_by = GIVEWAY_VERSION;
  EXPECT_EQ(BytesOf(file), test::FileOf(expected));
}

std::vector<std::string> FilesIn(const TempFolder& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.Path())) {
    names.push_back(entry.path().filename());
  }
  std::ranges::sort(names);
  return names;
}

// A vehicle that restarts, and several vehicles with one path: no file is ever overwritten.
TEST(Recorder, EveryRecordingWithOnePathIsAFileOfItsOwn) {
  const TempFolder folder;
  const std::string file = folder.Write("v.tape", "of the life before");
  {
    Recorder first(file);
    Recorder second(file);
    Drive(test::RecordedCrossing(3), &first);
    Drive(test::RecordedCrossing(5), &second);
  }
  Recorder(file).Close();
  EXPECT_THAT(FilesIn(folder), ElementsAre("v.2.tape", "v.3.tape", "v.4.tape", "v.tape"));
  EXPECT_EQ(BytesOf(file), "of the life before");
  EXPECT_EQ(StepsIn(BytesOf(folder.Path() + "/v.2.tape")), 3U);
  EXPECT_EQ(StepsIn(BytesOf(folder.Path() + "/v.3.tape")), 5U);
}

// One step a second, an image whenever one is due.
void DriveRing(const std::vector<Record>& records, Recorder* recorder, SteadyTime* now) {
  for (const Record& record : records) {
    if (const auto* life = std::get_if<RecordedLife>(&record)) {
      recorder->Begin(life->options, life->boot_epoch);
    } else if (const auto* step = std::get_if<RecordedStep>(&record)) {
      *now += std::chrono::seconds(1);
      recorder->Step(step->AsInputs(), step->outputs, step->hash);
      if (recorder->WantsImage(*now)) recorder->Image("a brain", step->hash, *now);
    }
  }
}

TEST(Recorder, ARingKeepsItsLastTwoFiles) {
  const TempFolder folder;
  SteadyTime now{1};
  {
    Recorder recorder(folder.Path() + "/v.tape", {.ring = std::chrono::seconds(10)});
    DriveRing(test::RecordedCrossing(95), &recorder, &now);
  }
  ASSERT_THAT(FilesIn(folder), ElementsAre("v.10.tape", "v.9.tape"));
  std::ifstream stream(folder.Path() + "/v.9.tape", std::ios::binary);
  RecordingFile file(&stream);
  ASSERT_TRUE(file.Continues());
  const auto first = file.Next();
  ASSERT_TRUE(first);
  const auto* image = std::get_if<RecordedImage>(&*first);
  ASSERT_NE(image, nullptr);
  EXPECT_EQ(image->state, "a brain");
  EXPECT_EQ(image->recorded_by, GIVEWAY_VERSION);
  EXPECT_EQ(StepsIn(BytesOf(folder.Path() + "/v.9.tape")), 11U);  // ten, and the image
}

TEST(Recorder, ARingThatIsKeptIsNotRemoved) {
  const TempFolder folder;
  SteadyTime now{1};
  Recorder recorder(folder.Path() + "/v.tape", {.ring = std::chrono::seconds(10)});
  std::vector<Record> records = test::RecordedCrossing(95);
  const std::vector<Record> before(records.begin(), records.begin() + 36);
  const std::vector<Record> after(records.begin() + 36, records.end());
  DriveRing(before, &recorder, &now);
  EXPECT_TRUE(recorder.Keep());
  DriveRing(after, &recorder, &now);
  recorder.Close();
  EXPECT_THAT(FilesIn(folder), ElementsAre("v.10.tape", "v.3.tape", "v.4.tape", "v.9.tape"));
}

TEST(Recorder, OnlyARingIsKeptAndNotForEver) {
  const TempFolder folder;
  Recorder whole(folder.Path() + "/whole");
  EXPECT_FALSE(whole.Keep());
  Recorder ring(folder.Path() + "/ring", {.ring = std::chrono::seconds(10)});
  int kept = 0;
  for (int i = 0; i < 20; ++i) kept += ring.Keep() ? 1 : 0;
  EXPECT_EQ(kept, 8);
}

TEST(Recorder, ALinkIsNotWrittenThrough) {
  const TempFolder folder;
  std::filesystem::create_symlink(folder.Path() + "/elsewhere", folder.Path() + "/tape");
  Recorder(folder.Path() + "/tape").Close();
  EXPECT_THAT(FilesIn(folder), ElementsAre("tape", "tape.2"));
}

// The last steps are dropped to fit the end record, which says why the file ends.
TEST(Recorder, AFullDiskIsToldByTheFile) {
  const TempFolder folder;
  const std::string file = folder.Path() + "/tape";
  RecorderTally tally;
  {
    const test::FullDisk full(20000);
    Recorder recorder(file);
    Drive(test::RecordedCrossing(100), &recorder);
    tally = recorder.Close();
  }
  EXPECT_GT(tally.steps, 10U);
  EXPECT_EQ(tally.steps + tally.lost, 100U);
  std::optional<RecordedEnd> end;
  EXPECT_EQ(StepsIn(BytesOf(file), &end), tally.steps);
  ASSERT_TRUE(end.has_value());
  EXPECT_EQ(end->steps, tally.steps);
  EXPECT_EQ(end->lost, tally.lost);
  EXPECT_EQ(end->failure, "File too large");
}

// A disk that is full when the recording starts: the vehicle drives.
TEST(Recorder, AFullDiskAtTheBeginningLosesEverythingAndStopsNothing) {
  const TempFolder folder;
  const test::FullDisk full(0);
  Recorder recorder(folder.Path() + "/tape");
  Drive(test::RecordedCrossing(20), &recorder);
  EXPECT_EQ(recorder.Close().lost, 20U);
}

TEST(Recorder, BeginsAnotherFileBeforeOneGrowsBeyondItsSize) {
  constexpr std::uint64_t kSplit = 10000;
  const TempFolder folder;
  const std::string file = folder.Path() + "/tape";
  {
    Recorder recorder(file, {.split_bytes = kSplit});
    Drive(test::RecordedCrossing(60), &recorder);
    EXPECT_EQ(recorder.Close().steps, 60U);
  }
  const std::vector<std::string> names = FilesIn(folder);
  EXPECT_GT(names.size(), 3U);
  std::uint32_t steps = 0;
  for (std::size_t i = 1; i <= names.size(); ++i) {
    const std::string bytes = BytesOf(i == 1 ? file : file + "." + std::to_string(i));
    EXPECT_LE(bytes.size(), kSplit);
    std::istringstream stream(bytes);
    RecordingFile part(&stream);
    EXPECT_EQ(part.Life().has_value(), i == 1);
    if (i > 1) {
      ASSERT_TRUE(part.Continues().has_value());
      EXPECT_EQ(part.Continues()->part, i);
      EXPECT_EQ(part.Continues()->steps_before, steps);
    }
    while (part.Next()) ++steps;
    ASSERT_TRUE(part.End().has_value());
    EXPECT_EQ(part.End()->continues, i < names.size());
  }
  EXPECT_EQ(steps, 60U);
}

TEST(Recorder, AFileThatCannotBeMadeIsAnErrorAtTheStart) {
  EXPECT_THROW(Recorder("/nowhere/at/all"), std::runtime_error);
}

TEST(Recorder, AFullDiskIsCountedAndNothingElse) {
  Recorder recorder("/dev/full");
  Drive(test::RecordedCrossing(20), &recorder);
  const RecorderTally tally = recorder.Close();
  EXPECT_EQ(tally.steps, 0U);
  EXPECT_EQ(tally.lost, 20U);
}

// A pipe that no process reads from is the slowest disk possible.
TEST(Recorder, ADiskThatHangsDoesNotHoldUpWhoSteps) {
  const TempFolder folder;
  const std::string pipe = folder.Path() + "/pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  constexpr std::uint32_t kSteps = 2000;
  auto recorder = std::make_unique<Recorder>(pipe);
  Drive(test::RecordedCrossing(kSteps), recorder.get());

  ::fcntl(reader, F_SETFL, 0);  // now the disk is back
  std::string bytes;
  std::thread disk([&] {
    char part[4096];
    for (ssize_t got; (got = ::read(reader, part, sizeof part)) > 0;) {
      bytes.append(part, static_cast<std::size_t>(got));
    }
  });
  const RecorderTally tally = recorder->Close();
  recorder.reset();  // closes the pipe
  disk.join();
  ::close(reader);
  EXPECT_GT(tally.lost, 0U);
  EXPECT_GT(tally.steps, 100U);
  EXPECT_EQ(tally.steps + tally.lost, kSteps);
  std::optional<RecordedEnd> end;
  EXPECT_EQ(StepsIn(bytes, &end), tally.steps);
  ASSERT_TRUE(end.has_value());
  EXPECT_EQ(end->lost, tally.lost);
}

TEST(SlotRing, IsFullWhenNobodyEmptiesIt) {
  SlotRing<int> ring(2);
  for (const int number : {7, 8}) {
    ASSERT_NE(ring.Free(), nullptr);
    *ring.Free() = number;
    ring.Push();
  }
  EXPECT_EQ(ring.Free(), nullptr);
  EXPECT_EQ(*ring.Next(), 7);
  ring.Pop();
  EXPECT_NE(ring.Free(), nullptr);
  ring.Close();
  EXPECT_EQ(*ring.Next(), 8);
  ring.Pop();
  EXPECT_EQ(ring.Next(), nullptr);
}

TEST(SlotRing, CarriesEverythingFromOneThreadToAnother) {
  constexpr int kCount = 100000;
  SlotRing<int> ring(4);
  std::int64_t sum = 0;
  std::thread emptying([&] {
    while (const int* number = ring.Next()) {
      sum += *number;
      ring.Pop();
    }
  });
  for (int i = 1; i <= kCount;) {
    int* const slot = ring.Free();
    if (slot == nullptr) {
      std::this_thread::yield();
      continue;
    }
    *slot = i++;
    ring.Push();
  }
  ring.Close();
  emptying.join();
  EXPECT_EQ(sum, std::int64_t{kCount} * (kCount + 1) / 2);
}

}  // namespace
}  // namespace giveway
