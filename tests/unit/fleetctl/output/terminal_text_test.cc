#include "services/fleetctl/output/terminal_text.h"

#include <gtest/gtest.h>

namespace giveway::fleetctl {
namespace {

TEST(TerminalText, AVerdictIsColouredAndNothingElse) {
  EXPECT_EQ(InColour("crossing: passed, all_held\n"),
            "crossing: \x1b[32mpassed\x1b[0m, all_held\n");
  EXPECT_EQ(InColour("a\nfailed: b"), "a\n\x1b[31mfailed\x1b[0m: b");
  EXPECT_EQ(InColour("x.xml:3: warning: y"), "x.xml:3: \x1b[33mwarning\x1b[0m: y");
  EXPECT_EQ(InColour("nothing here\n"), "nothing here\n");
}

// The first was not: only a run that failed showed a colour.
TEST(TerminalText, TheVerdictsOfRunsAndSoaksAreColoured) {
  EXPECT_EQ(InColour("PASSED  four_way: all_held"), "\x1b[32mPASSED\x1b[0m  four_way: all_held");
  EXPECT_EQ(InColour("FAILED  four_way: contact"), "\x1b[31mFAILED\x1b[0m  four_way: contact");
  EXPECT_EQ(InColour("NOT RUN  four_way: x"), "\x1b[31mNOT RUN\x1b[0m  four_way: x");
}

TEST(TerminalText, TheFirstVerdictOfALineIsTheOne) {
  EXPECT_EQ(InColour("failed: 3 passed"), "\x1b[31mfailed\x1b[0m: 3 passed");
}

TEST(TerminalText, APartOfAWordOrACountIsNoVerdict) {
  EXPECT_EQ(InColour("  runs 5, failed 0, contacts 0"), "  runs 5, failed 0, contacts 0");
  EXPECT_EQ(InColour("expectations_passed, terrors"), "expectations_passed, terrors");
}

TEST(TerminalText, LongLinesAreFoldedAtSpacesWithAHangingIndent) {
  EXPECT_EQ(Folded("  Remedy: raise the lease of both", 20),
            "  Remedy: raise the\n      lease of both");
  EXPECT_EQ(Folded("short\nlines\n", 20), "short\nlines\n");
  EXPECT_EQ(Folded("a_word_that_is_longer_than_the_line and", 10),
            "a_word_that_is_longer_than_the_line\n    and");
  EXPECT_EQ(Folded("five \xc2\xb5\xc2\xb5\xc2\xb5\xc2\xb5", 9),
            "five \xc2\xb5\xc2\xb5\xc2\xb5\xc2\xb5");
}

TEST(TerminalText, TimeLeftFollowsThePace) {
  EXPECT_EQ(TimeLeft(0, 10, 3), "no estimate yet");
  EXPECT_EQ(TimeLeft(5, 10, 20), "about 20 s left");
  EXPECT_EQ(TimeLeft(1, 11, 60), "about 10 min left");
  EXPECT_EQ(TimeLeft(10, 10, 20), "about 0 s left");
}

TEST(TerminalText, AProgressLineFitsTheTerminal) {
  EXPECT_EQ(ProgressLine(5, 10, "5/10", 18), "[#####.....] 5/10");
  for (std::size_t columns = 0; columns < 60; ++columns) {
    EXPECT_LE(ProgressLine(5, 10, "5/10 runs, 0 failing", columns).size(),
              columns > 0 ? columns - 1 : 0);
  }
}

}  // namespace
}  // namespace giveway::fleetctl
