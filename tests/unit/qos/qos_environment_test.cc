// Names of variables: which are ours, and which were probably meant to be.
#include <gmock/gmock.h>

#include "services/qos/qos_rules.h"

namespace giveway::qos {
namespace {

using ::testing::HasSubstr;

// What the rules find of a variable; empty: nothing.
std::string Found(std::string_view name) {
  Findings findings;
  CheckVariable(name, {}, "is set", &findings);
  return findings.empty() ? "" : findings.front().values;
}

TEST(Environment, OursAreNoMisspeltOnes) {
  for (const std::string_view name : OwnVariables()) EXPECT_EQ(Found(name), "") << name;
}

TEST(Environment, AMisspeltOneIsNamedWithTheOneThatIsNearest) {
  EXPECT_THAT(Found("GIVEWAY_DISCOVERY_SERVERS"), HasSubstr("GIVEWAY_DISCOVERY_SERVER is meant?"));
  EXPECT_THAT(Found("GIVEWAY_FOXGLOVEPORT"), HasSubstr("GIVEWAY_FOXGLOVE_PORT is meant?"));
  EXPECT_THAT(Found("GIVEWAY_ADMIN_KY"), HasSubstr("GIVEWAY_ADMIN_KEY is meant?"));
  EXPECT_THAT(Found("GIVEWAY_QSO"), HasSubstr("GIVEWAY_QOS is meant?"));
  EXPECT_THAT(Found("GIVEWAY_LOGFORMAT"), HasSubstr("GIVEWAY_LOG_FORMAT is meant?"));
}

// Short names are near to many words, and others have variables with our prefix, too.
TEST(Environment, AnotherWordIsNoMisspeltOne) {
  for (const char* name : {"GIVEWAY_ROOT", "GIVEWAY_BIN", "GIVEWAY_HOST", "GIVEWAY_JOBS",
                           "GIVEWAY_", "GIVEWAY", "GIVEWAY_WORLD_PORT", "GIVEWAY_IMAGE", "PATH"}) {
    EXPECT_EQ(Found(name), "") << name;
  }
  EXPECT_EQ(Found("GIVEWAY_" + std::string(100'000, 'A')), "");
}

}  // namespace
}  // namespace giveway::qos
