// What a service comes back with where its shared memory was deleted.
#include "services/node/service_run.h"

#include <gmock/gmock.h>

namespace giveway {
namespace {

using testing::ElementsAre;
using testing::Pair;

TEST(WithoutLostMemory, OneThatComesBackLeavesItOut) {
  const LifeEnd end = WithoutLostMemory({0, NewFlags{{"--resume", "a"}}}, true);
  ASSERT_TRUE(end.back.has_value());
  EXPECT_THAT(*end.back, ElementsAre(Pair("--leave-out", "shared_memory"), Pair("--resume", "a")));
}

TEST(WithoutLostMemory, WithItsMemoryItComesBackAsItWas) {
  const LifeEnd end = WithoutLostMemory({0, NewFlags{{"--resume", "a"}}}, false);
  ASSERT_TRUE(end.back.has_value());
  EXPECT_THAT(*end.back, ElementsAre(Pair("--resume", "a")));
}

TEST(WithoutLostMemory, OneThatEndsDoesNotComeBack) {
  const LifeEnd end = WithoutLostMemory({2, {}}, true);
  EXPECT_EQ(end.exit_code, 2);
  EXPECT_FALSE(end.back.has_value());
}

}  // namespace
}  // namespace giveway
