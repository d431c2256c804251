// The exit code of a recording that is shown: whole, cut off, damaged.
#include "services/fleetctl/playback/playback.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "services/fleetctl/virtual/virtual_show.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway::fleetctl {
namespace {

using testing::HasSubstr;

class PlaybackTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const TempFolder folder;
    CaseOptions options;
    options.scenario = "intersection_yield";
    const std::string path = folder.Path() + "/run.mcap";
    ShowRun(CaseMaker(options).Make(0), {.mcap = path}, {});
    std::ifstream file(path, std::ios::binary);
    whole_ = std::string(std::istreambuf_iterator<char>(file), {});
  }

  // The exit code; what was said is in said_.
  int Show(const std::string& recording) {
    std::filesystem::remove(page_);
    PlaybackOptions options;
    options.file = folder_.Write("run.mcap", recording);
    options.html_file = page_;
    testing::internal::CaptureStderr();
    const int code = RunPlayback(options);
    said_ = testing::internal::GetCapturedStderr();
    return code;
  }

  static inline std::string whole_;
  TempFolder folder_;
  const std::string page_ = folder_.Path() + "/run.html";
  std::string said_;
};

TEST_F(PlaybackTest, AWholeRecordingIsShown) {
  EXPECT_EQ(Show(whole_), 0);
  EXPECT_EQ(said_, "");
  EXPECT_TRUE(std::filesystem::exists(page_));
}

TEST_F(PlaybackTest, OneThatWasCutOffIsShownAsFarAsItGoes) {
  EXPECT_EQ(Show(whole_.substr(0, whole_.size() / 2)), 0);
  EXPECT_THAT(said_, HasSubstr("ends without its summary"));
  EXPECT_TRUE(std::filesystem::exists(page_));
}

TEST_F(PlaybackTest, OneThatIsDamagedIsShownUpToThereAndFails) {
  std::string damaged = whole_;
  damaged[damaged.size() / 2] = static_cast<char>(~damaged[damaged.size() / 2]);
  EXPECT_EQ(Show(damaged), 2);
  EXPECT_THAT(said_, HasSubstr("; shown up to there"));
  EXPECT_TRUE(std::filesystem::exists(page_));
}

TEST_F(PlaybackTest, OneWithoutAFleetIsNoPage) {
  EXPECT_EQ(Show("no recording at all"), 2);
  EXPECT_THAT(said_, HasSubstr("there is nothing of a fleet in it"));
  EXPECT_FALSE(std::filesystem::exists(page_));
}

}  // namespace
}  // namespace giveway::fleetctl
