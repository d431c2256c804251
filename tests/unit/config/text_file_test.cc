#include "services/config/text_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "services/config/problem.h"
#include "services/runtime/utf8.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway {
namespace {

using ::testing::HasSubstr;

std::string Refusal(const std::string& path) {
  try {
    ReadTextFile(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(TextFile, AGoodOneIsReadWhole) {
  const TempFolder folder;
  EXPECT_EQ(ReadTextFile(folder.Write("a", "caf\xc3\xa9\n")), "caf\xc3\xa9\n");
}

TEST(TextFile, WhatIsNoFileIsRefused) {
  const TempFolder folder;
  EXPECT_THAT(Refusal(folder.Path() + "/absent"), HasSubstr("does not exist"));
  EXPECT_THAT(Refusal(folder.Path()), HasSubstr("is a directory"));
  const std::string pipe = folder.Path() + "/pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(Refusal(pipe), HasSubstr("is no regular file"));
  EXPECT_THAT(Refusal("/dev/zero"), HasSubstr("is no regular file"));
}

TEST(TextFile, AnEmptyOneIsRefused) {
  const TempFolder folder;
  EXPECT_THAT(Refusal(folder.Write("a", "")), HasSubstr("is empty"));
}

TEST(TextFile, ABinaryOneIsRefused) {
  const TempFolder folder;
  EXPECT_THAT(Refusal(folder.Write("a", std::string("a\0b", 3))), HasSubstr("is binary"));
  EXPECT_THAT(Refusal(folder.Write("b",
                                   "\x7f"
                                   "ELF\xff")),
              HasSubstr("is binary"));
}

TEST(TextFile, ALargeOneIsRefusedUnread) {
  const TempFolder folder;
  const std::string file = folder.Write("a", "x");
  std::filesystem::resize_file(file, 100U << 20);  // sparse: reading it would find NUL bytes
  EXPECT_THAT(Refusal(file), HasSubstr("104857600 bytes; at most 8388608"));
  std::filesystem::resize_file(file, kMaxFileBytes);
  EXPECT_THAT(Refusal(file), HasSubstr("is binary"));
}

TEST(TextFile, DeepNestingIsRefusedWithItsLine) {
  const TempFolder folder;
  const std::string file = folder.Write("a", "x\n" + std::string(100'000, '{'));
  EXPECT_THAT(Refusal(file), HasSubstr(file + ":2: nests deeper than 32"));
}

TEST(TextFile, BracketsInStringsAndCommentsDoNotNest) {
  const std::string many(100, '{');
  EXPECT_EQ(LineNestedTooDeep("a: \"\\\"" + many + "\"\n# " + many + "\nb: '" + many + "'"), 0);
  EXPECT_EQ(LineNestedTooDeep("a: \"unclosed\n" + many), 2);
  EXPECT_EQ(LineNestedTooDeep(std::string(32, '<')), 0);
  EXPECT_EQ(LineNestedTooDeep(std::string(33, '[')), 1);
}

TEST(TextFile, OnlyWellFormedUtf8IsText) {
  EXPECT_TRUE(IsText("\x7f \xc2\x80 \xdf\xbf \xe0\xa0\x80 \xed\x9f\xbf \xee\x80\x80"));
  EXPECT_TRUE(IsText("\xf0\x90\x80\x80 \xf4\x8f\xbf\xbf"));
  for (const char* bad : {"\x80", "\xc1\xbf", "\xc3", "\xe0\x9f\xbf", "\xed\xa0\x80", "\xe2\x82",
                          "\xf0\x8f\xbf\xbf", "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xc3("}) {
    EXPECT_FALSE(IsText(bad)) << bad;
  }
}

}  // namespace
}  // namespace giveway
