#include "services/runtime/utf8.h"

#include <gtest/gtest.h>

#include <string>

namespace giveway {
namespace {

constexpr const char* kReplaced = "\xef\xbf\xbd";

std::string Replaced(std::size_t times) {
  std::string text;
  for (std::size_t i = 0; i < times; ++i) text += kReplaced;
  return text;
}

TEST(WellFormedText, StaysAsItIs) {
  for (const char* text :
       {"", "abc", "\x7f \xc2\x80 \xdf\xbf \xe0\xa0\x80 \xed\x9f\xbf \xee\x80\x80",
        "\xf0\x90\x80\x80 \xf4\x8f\xbf\xbf", "\xef\xbf\xbe \xef\xbf\xbf"}) {
    EXPECT_EQ(WellFormed(text), text);
  }
}

// Longer than needed, surrogates, beyond U+10FFFF, cut off.
TEST(WellFormedText, EachByteThatBelongsToNoSequenceIsReplaced) {
  for (const std::string text :
       {"\x80", "\xc1\xbf", "\xe0\x9f\xbf", "\xed\xa0\x80", "\xe2\x82", "\xf0\x8f\xbf\xbf",
        "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xff", "\xf0\x90\x80"}) {
    EXPECT_EQ(WellFormed(text), Replaced(text.size()));
    EXPECT_EQ(WellFormed("a" + text + "b"), "a" + Replaced(text.size()) + "b");
  }
  EXPECT_EQ(WellFormed("\xc3("), Replaced(1) + "(");
  EXPECT_EQ(WellFormed("\xe2\x82\xc3\xa9"), Replaced(2) + "\xc3\xa9");
}

TEST(IsTextOf, NulIsNoText) {
  EXPECT_TRUE(IsText("a"));
  EXPECT_FALSE(IsText(std::string_view("a\0b", 3)));
  EXPECT_TRUE(IsText("\xef\xbf\xbf"));
}

TEST(PrintableText, HasNothingThatATerminalObeys) {
  EXPECT_EQ(Printable("\x1b[2J a\tb\nc\x7f"), "?[2J a?b?c?");
  EXPECT_EQ(Printable("\xc3\xa9\xff"), "\xc3\xa9" + Replaced(1));
  // Regression: U+0080 to U+009F, of which U+009B starts a control sequence, passed.
  EXPECT_EQ(Printable("\xc2\x80\xc2\x9b\x32J\xc2\x9f\xc2\xa0\xc3\x80"), "??2J?\xc2\xa0\xc3\x80");
  EXPECT_EQ(Printable("\x9b"), Replaced(1));
}

TEST(ShortenedText, IsCutBetweenCharacters) {
  EXPECT_EQ(Shortened("abc", 3), "abc");
  EXPECT_EQ(Shortened("abcd", 3), "abc\xe2\x80\xa6");
  EXPECT_EQ(Shortened("ab\xc3\xa9", 3), "ab\xe2\x80\xa6");
  EXPECT_EQ(Shortened("\xe2\x82\xac\xe2\x82\xac", 2), "\xe2\x80\xa6");
}

}  // namespace
}  // namespace giveway
