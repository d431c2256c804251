#include "services/fleetctl/virtual/virtual_mcap.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "services/fleetctl/output/output_file.h"

namespace giveway::fleetctl {
namespace {

TEST(VirtualRecording, APathThatCannotBeWrittenIsRefusedBeforeTheRun) {
  const std::string taken = ::testing::TempDir() + "virtual_mcap_taken.mcap";
  std::ofstream(taken) << "precious";
  try {
    const VirtualRecording recording(taken);
    FAIL() << "no OutputError";
  } catch (const OutputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("File exists"));
  }
  EXPECT_EQ(std::filesystem::file_size(taken), 8U);
  std::filesystem::remove(taken);
}

TEST(VirtualRecording, OneThatIsNotClosedLeavesNoFile) {
  const std::string path = ::testing::TempDir() + "virtual_mcap_half.mcap";
  {
    const VirtualRecording recording(path);
    EXPECT_TRUE(std::filesystem::exists(path));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  CheckRecordable(path);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(VirtualRecording, ARunWithoutSamplesLeavesAFile) {
  const std::string path = ::testing::TempDir() + "virtual_mcap_empty.mcap";
  VirtualRecording recording(path);
  recording.Close();
  EXPECT_GT(std::filesystem::file_size(path), 0U);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace giveway::fleetctl
