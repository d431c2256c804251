// What fleetctl virtual prints of a run and what it writes of it say the same.
#include "services/fleetctl/virtual/virtual_show.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/virtual/virtual.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway::fleetctl {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class VirtualShowTest : public testing::Test {
 protected:
  std::string PathOf(const std::string& name) const { return folder_.Path() + "/" + name; }

  static std::string TextOf(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }

  // The exit code; what was printed is in printed_ and complained_.
  int Run(const VirtualOptions& options) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = RunVirtual(options);
    printed_ = testing::internal::GetCapturedStdout();
    complained_ = testing::internal::GetCapturedStderr();
    return code;
  }

  // A shipped scenario whose expectation a dead vehicle does not meet, though every invariant
  // holds.
  static VirtualOptions Unmet() {
    VirtualOptions options;
    options.made_by.scenario = "intersection_yield";
    options.made_by.crashes = {1, 1};
    options.seeds = {0, 0};
    return options;
  }

  TempFolder folder_;
  std::string printed_;
  std::string complained_;
};

TEST_F(VirtualShowTest, APictureOfARunThatMissedAnExpectationSaysFailed) {
  VirtualOptions options = Unmet();
  options.shown.picture = PathOf("run.svg");
  EXPECT_EQ(Run(options), 1);
  EXPECT_THAT(printed_, HasSubstr("FAILED, expectation"));
  const std::string svg = TextOf(options.shown.picture);
  EXPECT_THAT(svg, HasSubstr(">failed<"));
  EXPECT_THAT(svg, HasSubstr(">broken: expectation; seed 0: "));
  EXPECT_THAT(svg, Not(HasSubstr(">passed<")));
}

TEST_F(VirtualShowTest, APictureOfARunThatPassedSaysSo) {
  VirtualOptions options = Unmet();
  options.made_by.crashes = {0, 0};
  options.shown.picture = PathOf("run.svg");
  EXPECT_EQ(Run(options), 0);
  EXPECT_THAT(TextOf(options.shown.picture), HasSubstr(">passed<"));
}

TEST_F(VirtualShowTest, ARecordingThatCannotBeMadeIsRefusedBeforeTheRun) {
  VirtualOptions options = Unmet();
  for (const std::string& path : {folder_.Write("there.mcap", "precious"), PathOf("no/run.mcap")}) {
    options.shown.mcap = path;
    EXPECT_EQ(Run(options), 2) << path;
    EXPECT_EQ(printed_, "");
    EXPECT_THAT(complained_, HasSubstr(path + ": cannot be made: "));
    EXPECT_THAT(complained_, HasSubstr("; name a new file"));
  }
  EXPECT_EQ(TextOf(PathOf("there.mcap")), "precious");
}

TEST_F(VirtualShowTest, AFileThatCannotBeWrittenKeepsNoOtherFromIt) {
  const VirtualCase made = CaseMaker(Unmet().made_by).Make(0);
  for (const char* failing : {"run.mcap", "run.tsv", "run.svg"}) {
    const TempFolder folder;
    const auto path_of = [&](const std::string& name) {
      return folder.Path() + (name == failing ? "/none/" : "/") + name;
    };
    const ShownFiles files{path_of("run.svg"), path_of("run.tsv"), path_of("run.mcap")};
    EXPECT_THROW(ShowRun(made, files, {Verdict::kPassed, ""}), OutputError);
    for (const std::string& file : {files.picture, files.trace, files.mcap}) {
      EXPECT_EQ(std::filesystem::exists(file), file != path_of(failing)) << file;
    }
  }
}

}  // namespace
}  // namespace giveway::fleetctl
