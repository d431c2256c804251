#include "services/types/nearest_name.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace giveway {
namespace {

using testing::Optional;

const std::vector<std::string> kVerbs = {"doctor", "listen", "plan", "run", "virtual"};

TEST(NearestName, OneLetterWrong) {
  EXPECT_THAT(NearestName("rum", kVerbs), Optional(std::string("run")));
  EXPECT_THAT(NearestName("docter", kVerbs), Optional(std::string("doctor")));
}

TEST(NearestName, APrefixOfThreeLettersMeansTheName) {
  EXPECT_THAT(NearestName("vir", kVerbs), Optional(std::string("virtual")));
  EXPECT_EQ(NearestName("vi", kVerbs), std::nullopt);
}

TEST(NearestName, WhatIsFarFromAllIsNoneOfThem) {
  EXPECT_EQ(NearestName("zebra", kVerbs), std::nullopt);
  EXPECT_EQ(NearestName("", kVerbs), std::nullopt);
  EXPECT_EQ(NearestName("run", {}), std::nullopt);
}

TEST(NearestName, TheNearestOfSeveralIsTaken) {
  EXPECT_THAT(NearestName("--vehicels", {"--vehicle", "--vehicles", "--verify"}),
              Optional(std::string("--vehicles")));
  EXPECT_THAT(NearestName("lossy-radio", {"default", "lossy_radio", "same_host"}),
              Optional(std::string("lossy_radio")));
}

TEST(NearestName, IsPutAsAQuestion) {
  EXPECT_EQ(DidYouMean("rum", kVerbs), "; did you mean 'run'?");
  EXPECT_EQ(DidYouMean("zebra", kVerbs), "");
}

TEST(NearestName, DistanceCountsInsertedRemovedChangedAndSwappedLetters) {
  EXPECT_EQ(EditDistance("chekc", "check"), 1U);
  EXPECT_EQ(EditDistance("ab", "ba"), 1U);
  EXPECT_EQ(EditDistance("", "abc"), 3U);
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3U);
  EXPECT_EQ(EditDistance("same", "same"), 0U);
}

}  // namespace
}  // namespace giveway
