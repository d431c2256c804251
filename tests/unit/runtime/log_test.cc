#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/runtime/identity.h"
#include "services/runtime/process.h"

namespace giveway {
namespace {

using ::testing::HasSubstr;
using ::testing::internal::CaptureStderr;

// What was logged is written by a thread of the log's own.
std::string GetCapturedStderr() {
  EXPECT_TRUE(FlushLog(std::chrono::seconds(10)));
  return ::testing::internal::GetCapturedStderr();
}

TEST(Log, ALineIsAJsonObject) {
  CaptureStderr();
  InitLog("vehicle 1", "json", "debug");
  LogDebug("gives way to {} \"2\"\n");
  const std::string line = GetCapturedStderr();
  EXPECT_THAT(line,
              ::testing::MatchesRegex(
                  R"(\{"time":"....-..-..T..:..:..\....Z","steady_ns":[0-9]+,"level":"debug",)"
                  R"("process":"vehicle 1","text":"gives way to \{\} \\"2\\"\\n"\})"
                  "\n"));
}

TEST(Log, ALineCarriesWhenItWasNoticedAndNotWhenItWasWritten) {
  CaptureStderr();
  InitLog("vehicle 1", "json", "info");
  LogWarning("beacon_stale: vehicle 2", SteadyTime{1234});
  LogInfo("cruise");
  const std::string lines = GetCapturedStderr();
  EXPECT_THAT(lines, HasSubstr("\"steady_ns\":1234,"));
  EXPECT_THAT(lines.substr(lines.find('\n')), ::testing::Not(HasSubstr("\"steady_ns\":1234,")));
}

TEST(Log, TextNamesLevelAndProcess) {
  CaptureStderr();
  InitLog("world", "text", "info");
  LogWarning("tick late");
  EXPECT_THAT(GetCapturedStderr(), HasSubstr("warning world: tick late\n"));
}

// Regression: with three vehicles without --id every line had "process":"vehicle".
TEST(Log, NamesAVehicleByTheIdThatTheWorldGave) {
  CaptureStderr();
  InitLog("vehicle", "json", "info");
  LogInfo("before");
  SetLogVehicle(VehicleId{3});
  LogInfo("after");
  InitLog("vehicle", "text", "info");
  LogInfo("cruise");
  SetLogVehicle(kNoVehicle);
  LogInfo("over");
  FlushLog(std::chrono::seconds(5));
  const std::string lines = GetCapturedStderr();
  EXPECT_THAT(lines, HasSubstr("\"process\":\"vehicle\",\"text\":\"before\""));
  EXPECT_THAT(lines, HasSubstr("\"process\":\"vehicle\",\"vehicle\":3,\"text\":\"after\""));
  EXPECT_THAT(lines, HasSubstr(" vehicle 3: cruise"));
  EXPECT_THAT(lines, HasSubstr(" vehicle: over"));
}

TEST(Log, LevelsBelowTheOneAskedForAreSilent) {
  CaptureStderr();
  InitLog("world", "text", "warning");
  LogDebug("one");
  LogInfo("two");
  LogWarning("three");
  LogError("four");
  const std::string text = GetCapturedStderr();
  EXPECT_THAT(text, ::testing::Not(HasSubstr("two")));
  EXPECT_THAT(text, HasSubstr("three"));
  EXPECT_THAT(text, HasSubstr("error   world: four"));
}

}  // namespace
}  // namespace giveway
