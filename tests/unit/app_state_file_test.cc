#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "services/app/state_file.h"

namespace giveway::app {
namespace {

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

// A process that dies while it writes leaves its half beside.
TEST_F(StateFile, AHalfWrittenOneDoesNotTakeTheOldOnesPlace) {
  EXPECT_EQ(WriteStateFile(file_, "whole"), "");
  std::ofstream(file_ + ".new") << "ha";
  EXPECT_EQ(ReadStateFile(file_), "whole");
  EXPECT_EQ(WriteStateFile(file_, "next"), "");
  EXPECT_EQ(ReadStateFile(file_), "next");
  EXPECT_FALSE(std::filesystem::exists(file_ + ".new"));
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

}  // namespace
}  // namespace giveway::app
