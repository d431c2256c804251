#include "services/runtime/json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace giveway {
namespace {

TEST(JsonText, EscapesWhatItMust) {
  EXPECT_EQ(JsonText("a \"b\" \\ \n\t\x01"), R"("a \"b\" \\ \n\t\u0001")");
  EXPECT_EQ(JsonText("caf\xc3\xa9 \x7f"), "\"caf\xc3\xa9 \x7f\"");
  EXPECT_EQ(JsonText(""), "\"\"");
}

TEST(JsonText, BytesThatAreNotUtf8AreReplaced) {
  EXPECT_EQ(JsonText("\xff"
                     "a"),
            "\"\xef\xbf\xbd"
            "a\"");
  EXPECT_EQ(JsonText("\xed\xa0\x80").find_first_of("\xed"), std::string::npos);
  Json object;
  object["\xc3("] = "\xe2\x82";
  EXPECT_TRUE(ReadJson(JsonText(object))) << JsonText(object);
}

TEST(JsonText, KeysStayInTheOrderInWhichTheyCame) {
  Json object;
  object["b"] = 1;
  object["a"] = true;
  object["c"]["z"] = "x";
  object["c"]["y"] = std::vector<int>{3, 2};
  EXPECT_EQ(JsonText(object), R"({"b":1,"a":true,"c":{"z":"x","y":[3,2]}})");
}

TEST(JsonText, WhatDoesNotExistIsLeftOutOfAnObjectAndNullInAnArray) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Json object;
  object["first"] = nullptr;
  object["nan"] = kNan;
  object["kept"] = 1;
  object["infinite"]["x"] = -std::numeric_limits<double>::infinity();
  object["list"] = {1, kNan, nullptr};
  object["none"] = OrNull(std::optional<double>());
  object["some"] = OrNull(std::optional<double>(0.5));
  object["last"] = nullptr;
  EXPECT_EQ(JsonText(object), R"({"kept":1,"infinite":{},"list":[1,null,null],"some":0.5})");
}

TEST(JsonText, WholeNumbersHaveNoFraction) {
  EXPECT_EQ(JsonText({5.0, -3.0, 0.0, 0.25, 1e15, 9007199254740992.0}),
            "[5,-3,0,0.25,1000000000000000,9007199254740992]");
  EXPECT_EQ(JsonText(1e16), "1e+16");
  EXPECT_EQ(JsonText(1e-05), "1e-05");
  EXPECT_EQ(JsonText(0.0001), "0.0001");
  EXPECT_EQ(JsonText(std::numeric_limits<std::uint64_t>::max()), "18446744073709551615");
  // The same number, and its sign.
  EXPECT_TRUE(std::signbit(ReadJson(JsonText(-0.0))->get<double>()));
}

TEST(JsonArrayOf, TakesFunctionsAndMembers) {
  const std::vector<std::string> words{"a", "bc"};
  EXPECT_EQ(JsonText(JsonArray(words, &std::string::size)), "[1,2]");
  EXPECT_EQ(JsonText(JsonArray(std::vector<int>(), [](int i) { return i; })), "[]");
}

TEST(ReadJsonText, TakesJsonAndNothingElse) {
  EXPECT_EQ(ReadJson(R"({"b":[1,{}],"a":2.5})")->at("a"), 2.5);
  for (const char* text :
       {"", "{", "{\"a\":1}}", "{\"a\":1,}", "nan", "\"\xff\"", "[1] x", "{'a':1}"}) {
    EXPECT_FALSE(ReadJson(text)) << text;
  }
}

TEST(ReadJsonText, DeepNestingIsRefused) {
  const auto nested = [](std::size_t depth) {
    return ReadJson(std::string(depth, '[') + std::string(depth, ']'));
  };
  EXPECT_TRUE(nested(kMostJsonDepth));
  EXPECT_FALSE(nested(kMostJsonDepth + 1));
  EXPECT_FALSE(nested(1'000'000));
  EXPECT_FALSE(ReadJson(std::string(1'000'000, '[')));
}

TEST(ReadJsonText, OnlyWholeNumbersOf32BitsAreTaken) {
  EXPECT_EQ(Uint32Of(0U), 0U);
  EXPECT_EQ(Uint32Of(*ReadJson("4294967295")), 4294967295U);
  for (const char* text : {"-1", "1.5", "4294967296", "1e99", "\"1\"", "null", "[1]", "true"}) {
    EXPECT_THROW(Uint32Of(*ReadJson(text)), std::range_error) << text;
  }
}

}  // namespace
}  // namespace giveway
