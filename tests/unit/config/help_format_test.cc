#include "services/config/help/help_format.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace giveway {
namespace {

using testing::HasSubstr;
using testing::Not;

std::size_t LongestLine(const std::string& text) {
  std::istringstream lines(text);
  std::size_t longest = 0;
  for (std::string line; std::getline(lines, line);) longest = std::max(longest, line.size());
  return longest;
}

class HelpFormatTest : public testing::Test {
 protected:
  std::string Help(std::size_t columns) {
    CLI::App app("Runs a scenario.", "tool");
    app.formatter(std::make_shared<HelpFormat>(columns));
    app.footer(
        "\nA long note that is wider than any terminal, however wide that one may be, so that it "
        "must "
        "be\nwrapped.\n\nExamples\n  tool run crossing --seed 7 --picture crossing.svg      # a "
        "picture of both paths in the end\n\nExit code: 0 passed.\n");
    app.add_option("SCENARIO", scenario_, "A file, or a shipped one")->required();
    app.add_option("--seed", seed_, "Of all that is drawn")
        ->check(CLI::Range(0U, std::numeric_limits<std::uint32_t>::max()))
        ->envname("GIVEWAY_SEED");
    app.add_option("--level", level_,
                   "Of the log of the world and of every vehicle that this run starts")
        ->check(CLI::IsMember({"debug", "info"}));
    app.add_option("--duration,--seconds", seconds_, "How long")->check(CLI::Range(1.5, 99.0));
    return app.help();
  }

  std::string scenario_, level_;
  unsigned seed_ = 0;
  double seconds_ = 2;
};

TEST_F(HelpFormatTest, NoLineIsWiderThanTheTerminal) {
  EXPECT_LE(LongestLine(Help(60)), 60U);
  EXPECT_LE(LongestLine(Help(80)), 80U);
  EXPECT_LE(LongestLine(Help(120)), 120U);
}

TEST_F(HelpFormatTest, UsageShowsHowOftenAnArgumentMayBeGiven) {
  CLI::App app("Compares.", "tool");
  app.formatter(std::make_shared<HelpFormat>(80));
  std::vector<std::string> one_or_two;
  std::vector<std::string> any;
  app.add_option("REPORT", one_or_two)->required()->expected(1, 2);
  app.add_option("FILE", any);
  EXPECT_THAT(app.help(), HasSubstr("Usage: tool REPORT [REPORT] [FILE...] [FLAGS]"));
}

TEST_F(HelpFormatTest, ExamplesComeBeforeFlagsAndNotesAfter) {
  const std::string help = Help(80);
  EXPECT_LT(help.find("Examples:"), help.find("Arguments:"));
  EXPECT_LT(help.find("Arguments"), help.find("--seed N"));
  EXPECT_LT(help.find("--level"), help.find("A long note"));
  EXPECT_LT(help.find("A long note"), help.find("Exit code"));
}

TEST_F(HelpFormatTest, ValuesAreShownAsAUserWritesThem) {
  const std::string help = Help(80);
  EXPECT_THAT(help, HasSubstr("--seed N "));
  EXPECT_THAT(help, HasSubstr("--level debug|info"));
  EXPECT_THAT(help, HasSubstr("--duration 1.5..99"));
  EXPECT_THAT(help, Not(HasSubstr("UINT")));
  EXPECT_THAT(help, Not(HasSubstr("4294967295")));
}

TEST_F(HelpFormatTest, FormerNamesAreNotShown) {
  EXPECT_THAT(Help(80), Not(HasSubstr("--seconds")));
}

TEST_F(HelpFormatTest, TheTwinInTheEnvironmentIsNamed) {
  EXPECT_THAT(Help(80), HasSubstr("[GIVEWAY_SEED]"));
}

TEST(HelpFormat, AnExampleThatIsTooLongHasItsCommentAbove) {
  EXPECT_EQ(WrapParagraphs("  tool run crossing --seed 7      # with another seed", 40),
            "  # with another seed\n  tool run crossing --seed 7\n");
  // None of its lines looks like a command.
  EXPECT_EQ(WrapParagraphs("  tool run crossing      # with another seed than before", 24),
            "  # with another seed\n  # than before\n  tool run crossing\n");
}

TEST(HelpFormat, ValueNames) {
  EXPECT_EQ(ValueName("UINT:UINT in [1 - 99]"), "1..99");
  EXPECT_EQ(ValueName("UINT:UINT in [0 - 4294967295]"), "N");
  EXPECT_EQ(ValueName("UINT"), "N");
  EXPECT_EQ(ValueName("FLOAT"), "NUMBER");
  EXPECT_EQ(ValueName("TEXT:{a,b,c}"), "a|b|c");
  EXPECT_EQ(ValueName("HOST[:PORT],..."), "HOST[:PORT],...");
}

}  // namespace
}  // namespace giveway
