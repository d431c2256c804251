#include "services/runtime/state_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>

#include "services/runtime/fault_reminder.h"
#include "tests/support/full_disk.h"

namespace giveway {
namespace {

using test::FullDisk;

class StateFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "giveway-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    file_ = folder_ / "state";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
  std::string file_;
};

TEST_F(StateFile, GivesBackEveryByteOfTheNewestState) {
  EXPECT_EQ(ReadStateFile(file_), std::nullopt);
  const std::string bytes("a\0b\n\xff", 5);
  EXPECT_EQ(WriteStateFile(file_, "an older and longer one"), "");
  EXPECT_EQ(WriteStateFile(file_, bytes), "");
  EXPECT_EQ(ReadStateFile(file_), bytes);
  RemoveStateFile(file_);
  EXPECT_EQ(ReadStateFile(file_), std::nullopt);
}

// A process that dies while writing leaves only its temporary file.
TEST_F(StateFile, AHalfWrittenOneDoesNotTakeTheOldOnesPlace) {
  EXPECT_EQ(WriteStateFile(file_, "whole"), "");
  std::ofstream(file_ + ".new") << "ha";
  EXPECT_EQ(ReadStateFile(file_), "whole");
  EXPECT_EQ(WriteStateFile(file_, "next"), "");
  EXPECT_EQ(ReadStateFile(file_), "next");
  EXPECT_FALSE(std::filesystem::exists(file_ + ".new"));
}

// A checkpoint in a folder that other users can write to: their link must not redirect it.
TEST_F(StateFile, ASymbolicLinkIsReplacedAndNotFollowed) {
  const std::string victim = folder_ / "linked";
  std::ofstream(victim) << "not ours";
  for (const std::string& link : {file_ + ".new", file_}) {
    std::filesystem::create_symlink(victim, link);
    EXPECT_EQ(WriteStateFile(file_, "ours"), "");
    EXPECT_EQ(ReadStateFile(victim), "not ours");
    EXPECT_EQ(ReadStateFile(file_), "ours");
    EXPECT_FALSE(std::filesystem::is_symlink(file_));
    std::filesystem::remove(file_);
  }
}

// A disk as full as RLIMIT_FSIZE makes it, which also raises SIGXFSZ.
TEST_F(StateFile, OnAFullDiskTheOldOneStaysAndNothingLiesBeside) {
  EXPECT_EQ(WriteStateFile(file_, "whole"), "");
  {
    const FullDisk full(1000);
    EXPECT_NE(WriteStateFile(file_, std::string(5000, 'x')), "");
    EXPECT_NE(WriteOutputFile(file_, std::string(5000, 'x')), "");
  }
  EXPECT_EQ(ReadStateFile(file_), "whole");
  const auto files = std::filesystem::directory_iterator(folder_);
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST_F(StateFile, AnOutputFollowsALinkAndKeepsTheModeOfWhatItReplaces) {
  const std::string target = folder_ / "target";
  std::ofstream(target) << "an older and longer text";
  std::filesystem::permissions(target, std::filesystem::perms::owner_all);
  std::filesystem::create_symlink(target, file_);
  EXPECT_EQ(WhyNotWritable(file_), "");
  EXPECT_EQ(WriteOutputFile(file_, "text"), "");
  EXPECT_TRUE(std::filesystem::is_symlink(file_));
  EXPECT_EQ(ReadStateFile(target), "text");
  EXPECT_EQ(std::filesystem::status(target).permissions(), std::filesystem::perms::owner_all);
}

TEST_F(StateFile, ADeviceIsWrittenToAsItIs) {
  EXPECT_EQ(WhyNotWritable("/dev/null"), "");
  EXPECT_EQ(WriteOutputFile("/dev/null", "text"), "");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  EXPECT_NE(WriteOutputFile("/dev/full", "text").find("No space left"), std::string::npos);
}

// Regression: whatever was in /dev was taken for a device: a new file in /dev/shm was refused, and
// an older one was appended to.
TEST_F(StateFile, AFileInSharedMemoryIsWrittenAsAnyOther) {
  const std::string file = "/dev/shm/giveway-output-test-" + std::to_string(::getpid());
  EXPECT_EQ(WhyNotWritable(file), "");
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_EQ(WriteOutputFile(file, "an older and longer text"), "");
  EXPECT_EQ(WriteOutputFile(file, "text"), "");
  EXPECT_EQ(ReadStateFile(file), "text");
  std::filesystem::remove(file);
}

// What a shell opened for a program: a file put in its place would not be the one that is open.
TEST_F(StateFile, AFileThatIsReachedThroughADescriptorIsAppendedTo) {
  std::ofstream(file_) << "before, ";
  const int open_file = ::open(file_.c_str(), O_WRONLY | O_CLOEXEC);
  const std::string name = "/dev/fd/" + std::to_string(open_file);
  std::filesystem::create_symlink(name, folder_ / "link");
  EXPECT_EQ(WhyNotWritable(name), "");
  EXPECT_EQ(WriteOutputFile(name, "now, "), "");
  EXPECT_EQ(WriteOutputFile("/proc/self/fd/" + std::to_string(open_file), "then, "), "");
  EXPECT_EQ(WriteOutputFile(folder_ / "link", "and by a link"), "");
  struct stat opened {};
  struct stat named {};
  ::fstat(open_file, &opened);
  ::stat(file_.c_str(), &named);
  EXPECT_EQ(opened.st_ino, named.st_ino);
  ::close(open_file);
  EXPECT_EQ(ReadStateFile(file_), "before, now, then, and by a link");
}

TEST(FaultReminder, SaysAFaultOnceThenOnceAMinuteAndThatItIsOver) {
  using std::chrono::seconds;
  FaultReminder reminder;
  EXPECT_EQ(reminder.Note("", seconds(1)), "");
  int lines = 0;
  for (int i = 0; i < 150 * 5; ++i) {  // five attempts a second for two and a half minutes
    lines +=
        reminder.Note("no space", seconds(10) + i * std::chrono::milliseconds(200)).empty() ? 0 : 1;
  }
  EXPECT_EQ(lines, 3);
  EXPECT_NE(reminder.Note("", seconds(200)).find("750"), std::string::npos);
  EXPECT_EQ(reminder.Note("", seconds(201)), "");
  EXPECT_EQ(reminder.Note("no space", seconds(202)), "no space");
}

TEST_F(StateFile, AFolderThatIsNotThereIsSaid) {
  const std::string nowhere = (folder_ / "no" / "state").string();
  EXPECT_NE(WriteStateFile(nowhere, "x").find(nowhere), std::string::npos);
  EXPECT_EQ(ReadStateFile(nowhere), std::nullopt);
}

TEST_F(StateFile, AFolderIsNoState) {
  std::filesystem::create_directory(file_);
  EXPECT_THROW(ReadStateFile(file_), std::runtime_error);
  EXPECT_NE(WriteStateFile(file_, "x"), "");
}

// Regression: of a process that ended while its file in /proc was read a stream threw, and fleetctl
// doctor ended with exit code 2.
TEST(ReadWholeFile, WhatCannotBeReadToItsEndIsNothing) {
  EXPECT_EQ(ReadWholeFile("/proc/self/mem"), std::nullopt);  // opens, and cannot be read at 0
  EXPECT_EQ(errno, EIO);
  EXPECT_EQ(ReadWholeFile("/proc/self"), std::nullopt);
  EXPECT_EQ(errno, EISDIR);
  EXPECT_EQ(ReadWholeFile("/proc/self/absent"), std::nullopt);
  EXPECT_EQ(errno, ENOENT);
  EXPECT_NE(ReadWholeFile("/proc/self/stat").value_or(""), "");  // whose size is 0
}

}  // namespace
}  // namespace giveway
