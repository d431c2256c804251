#include "services/observer/capture/capture_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "services/mcap/mcap_reader.h"
#include "tests/support/full_disk.h"

namespace giveway {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

class CaptureFilesTest : public ::testing::Test {
 protected:
  CaptureFilesTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~CaptureFilesTest() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return folder_ + "/" + name; }
  // Of bytes that do not compress: a part's size is that of its file.
  link::RawSample Sample(std::size_t size) {
    link::RawSample sample{.source_ns = 1, .reception_ns = 2, .sequence = 3};
    for (std::size_t i = 0; i < size; ++i) sample.bytes += static_cast<char>(random_());
    return sample;
  }
  static std::uint64_t MessagesIn(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    return mcap::McapReader::Read(bytes, [](const auto&, const auto&, const auto&) { return true; })
        .messages;
  }

  std::minstd_rand random_{1};
  const std::string folder_ = ::testing::TempDir() + "capture_files_" +
                              ::testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(CaptureFilesTest, OneFileWithoutASplit) {
  CaptureFiles files({.path = Path("run.mcap")}, {});
  for (int n = 0; n < 10; ++n) EXPECT_TRUE(files.Write(Sample(100), SteadyTime{0}));
  EXPECT_TRUE(files.Close());
  EXPECT_EQ(MessagesIn(Path("run.mcap")), 10U);
  EXPECT_EQ(files.Parts(), 1U);
}

TEST_F(CaptureFilesTest, PartsBySizeAndTheOldestGo) {
  CaptureFiles files({.path = Path("run.mcap"), .split_bytes = 1'000'000, .keep_bytes = 3'000'000},
                     {});
  for (int n = 0; n < 100; ++n) EXPECT_TRUE(files.Write(Sample(100'000), SteadyTime{0}));
  EXPECT_TRUE(files.Close());
  EXPECT_GT(files.Parts(), 5U);
  EXPECT_FALSE(fs::exists(Path("run-0001.mcap")));
  EXPECT_GT(MessagesIn(Path("run-" + std::string(files.Parts() < 10 ? "000" : "00") +
                            std::to_string(files.Parts()) + ".mcap")),
            0U);
}

TEST_F(CaptureFilesTest, PartsByTime) {
  CaptureFiles files({.path = Path("run.mcap"), .split_time = std::chrono::seconds(10)}, {});
  for (int second = 0; second < 30; ++second) {
    files.Write(Sample(10), std::chrono::seconds(second));
  }
  EXPECT_TRUE(files.Close());
  EXPECT_EQ(files.Parts(), 3U);
  EXPECT_EQ(MessagesIn(Path("run-0002.mcap")), 10U);
}

TEST_F(CaptureFilesTest, WhatIsThereIsNotOverwritten) {
  std::ofstream(Path("run.mcap")) << "precious";
  CaptureFiles files({.path = Path("run.mcap")}, {});
  EXPECT_FALSE(files.Write(Sample(1), SteadyTime{0}));
  EXPECT_THAT(files.Fault(), HasSubstr("run.mcap: cannot be made: File exists"));
  EXPECT_FALSE(files.Close());
  EXPECT_EQ(fs::file_size(Path("run.mcap")), 8U);
}

TEST_F(CaptureFilesTest, APathThatIsTakenIsKnownAtTheStart) {
  std::ofstream(Path("run.mcap")) << "precious";
  CaptureFiles files({.path = Path("run.mcap")}, {});
  EXPECT_FALSE(files.Start(SteadyTime{0}));
  EXPECT_THAT(files.Fault(), HasSubstr("run.mcap: cannot be made: File exists"));
}

TEST_F(CaptureFilesTest, TheFileOfALaterSampleIsThereFromTheStart) {
  CaptureFiles files({.path = Path("run.mcap")}, {});
  EXPECT_TRUE(files.Start(SteadyTime{0}));
  EXPECT_TRUE(fs::exists(Path("run.mcap")));
  EXPECT_TRUE(files.Write(Sample(1), SteadyTime{0}));
  EXPECT_TRUE(files.Close());
  EXPECT_EQ(files.Parts(), 1U);
  EXPECT_EQ(MessagesIn(Path("run.mcap")), 1U);
}

TEST_F(CaptureFilesTest, OneThatIsDiscardedLeavesOnlyWhatWasThere) {
  std::ofstream(Path("other.mcap")) << "precious";
  CaptureFiles whole({.path = Path("run.mcap"), .most_chunks = 1}, {});
  for (int n = 0; n < 30; ++n) EXPECT_TRUE(whole.Write(Sample(1'000'000), SteadyTime{0}));
  EXPECT_GT(whole.Parts(), 2U);
  whole.Discard();
  CaptureFiles taken({.path = Path("other.mcap")}, {});
  EXPECT_FALSE(taken.Start(SteadyTime{0}));
  taken.Discard();
  std::vector<std::string> left;
  for (const auto& file : fs::directory_iterator(folder_)) left.push_back(file.path().filename());
  EXPECT_THAT(left, ::testing::ElementsAre("other.mcap"));
}

TEST_F(CaptureFilesTest, DiscardedPartsLeaveThoseOfAnEarlierRecording) {
  const CaptureOptions options{.path = Path("run.mcap"), .split_time = std::chrono::seconds(10)};
  CaptureFiles earlier(options, {});
  EXPECT_TRUE(earlier.Write(Sample(10), SteadyTime{0}));
  EXPECT_TRUE(earlier.Close());
  CaptureFiles discarded(options, {});
  for (int s = 0; s < 30; ++s) EXPECT_TRUE(discarded.Write(Sample(10), std::chrono::seconds(s)));
  EXPECT_TRUE(fs::exists(Path("run-0004.mcap")));
  discarded.Discard();
  EXPECT_TRUE(fs::exists(Path("run-0001.mcap")));
  for (const char* part : {"run-0002.mcap", "run-0003.mcap", "run-0004.mcap"}) {
    EXPECT_FALSE(fs::exists(Path(part))) << part;
  }
}

TEST_F(CaptureFilesTest, AllPartsTogetherStayWithinWhatIsKept) {
  constexpr std::uint64_t kKeep = 2'500'000;
  CaptureFiles files({.path = Path("run.mcap"), .split_bytes = 10'000'000, .keep_bytes = kKeep},
                     {});
  const auto taken = [this] {
    std::uint64_t bytes = 0;
    for (const auto& file : fs::directory_iterator(folder_)) bytes += file.file_size();
    return bytes;
  };
  for (int n = 0; n < 100; ++n) {
    EXPECT_TRUE(files.Write(Sample(100'000), SteadyTime{0}));
    EXPECT_TRUE(files.Flush());
    EXPECT_LE(taken(), kKeep);
  }
  EXPECT_TRUE(files.Close());
  EXPECT_LE(taken(), kKeep);
  EXPECT_GT(taken(), kKeep / 2);
}

// It started from 0001 again and failed hours later, at the first number that was still there.
TEST_F(CaptureFilesTest, ARestartedRecorderContinuesAfterThePartsThatAreThere) {
  const CaptureOptions options{
      .path = Path("run.mcap"), .split_time = std::chrono::seconds(10), .keep_bytes = 3'000'000};
  const auto file_of = [this](std::size_t size, const std::string& name) {
    std::ofstream(Path(name)) << std::string(size, 'x');
  };
  file_of(1'500'000, "run-0003.mcap");
  file_of(1'300'000, "run-0004.mcap");
  for (const char* other : {"run-9.mcap", "run-0007.mcap.new", "run-fast-0008.mcap", "run-a.mcap"})
    file_of(2'000'000, other);
  CaptureFiles files(options, {});
  for (int second = 0; second < 20; ++second) {
    EXPECT_TRUE(files.Write(Sample(50'000), std::chrono::seconds(second))) << files.Fault();
    EXPECT_TRUE(files.Flush());
  }
  EXPECT_TRUE(files.Close());
  EXPECT_EQ(files.Parts(), 2U);
  EXPECT_EQ(MessagesIn(Path("run-0005.mcap")), 10U);
  EXPECT_EQ(MessagesIn(Path("run-0006.mcap")), 10U);
  EXPECT_FALSE(fs::exists(Path("run-0003.mcap"))) << "all parts together are within --keep";
  EXPECT_TRUE(fs::exists(Path("run-0004.mcap")));
  EXPECT_TRUE(fs::exists(Path("run-9.mcap"))) << "it is no part";
}

TEST_F(CaptureFilesTest, OfPartsThatAnotherRecorderWritesNothingIsTakenOver) {
  const CaptureOptions options{.path = Path("run.mcap"), .split_bytes = 1'000'000};
  CaptureFiles first(options, {});
  EXPECT_TRUE(first.Start(SteadyTime{0}));
  CaptureFiles second(options, {});
  EXPECT_FALSE(second.Start(SteadyTime{0}));
  EXPECT_THAT(second.Fault(), HasSubstr("run-0001.mcap: another recorder writes it"));
  EXPECT_FALSE(second.Close());
  EXPECT_TRUE(first.Close());
  CaptureFiles third(options, {});
  EXPECT_TRUE(third.Start(SteadyTime{0}));
}

TEST_F(CaptureFilesTest, APartWhoseIndexHasGrownLargeIsFollowedByAnother) {
  CaptureFiles files({.path = Path("run.mcap"), .most_chunks = 10}, {});
  for (int n = 0; n < 25; ++n) {
    EXPECT_TRUE(files.Write(Sample(1), SteadyTime{0}));
    EXPECT_TRUE(files.Flush());
  }
  EXPECT_TRUE(files.Close());
  EXPECT_EQ(files.Parts(), 3U);
  EXPECT_EQ(MessagesIn(Path("run.mcap")), 10U);
  EXPECT_EQ(MessagesIn(Path("run-0002.mcap")), 10U);
  EXPECT_EQ(MessagesIn(Path("run-0003.mcap")), 5U);
}

TEST_F(CaptureFilesTest, AFolderThatIsNoneIsSaid) {
  CaptureFiles files({.path = Path("none/run.mcap")}, {});
  EXPECT_FALSE(files.Write(Sample(1), SteadyTime{0}));
  EXPECT_THAT(files.Fault(), HasSubstr("cannot be made"));
}

TEST_F(CaptureFilesTest, AFullDiskEndsItInWordsAndLeavesWhatWasFlushed) {
  CaptureFiles files({.path = Path("run.mcap")}, {});
  {
    const test::FullDisk full(500'000);
    for (int n = 0; n < 4; ++n) EXPECT_TRUE(files.Write(Sample(100'000), SteadyTime{0}));
    EXPECT_TRUE(files.Flush());
    EXPECT_TRUE(files.Write(Sample(200'000), SteadyTime{0}));
    EXPECT_FALSE(files.Flush());
    EXPECT_THAT(files.Fault(), HasSubstr("cannot be written; the recording ends here"));
    EXPECT_FALSE(files.Write(Sample(1), SteadyTime{0}));
    EXPECT_FALSE(files.Close());
  }
  EXPECT_EQ(fs::file_size(Path("run.mcap")), 500'000U);
  EXPECT_EQ(MessagesIn(Path("run.mcap")), 4U);
}

TEST_F(CaptureFilesTest, FilesAreAttachedAndOneThatIsMissingIsNamed) {
  std::ofstream(Path("brain.recording")) << "brain's bytes";
  CaptureFiles files(
      {.path = Path("run.mcap"), .attachments = {Path("brain.recording"), Path("other.recording")}},
      {});
  files.Write(Sample(1), SteadyTime{0});
  EXPECT_TRUE(files.Close());
  EXPECT_THAT(files.Missing(), HasSubstr("other.recording"));
  std::ifstream file(Path("run.mcap"), std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  EXPECT_THAT(bytes, HasSubstr("brain's bytes"));
}

}  // namespace
}  // namespace giveway
