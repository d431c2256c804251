// What a service that restarts itself hands on to its next process image.
#include "services/node/service_run.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <string>

#include "services/runtime/restart.h"

namespace giveway {
namespace {

constexpr const char* kCounts = "GIVEWAY_TEST_COUNTS_HELD";
constexpr int kNotRestarted = 99;

// This program, restarted by a test: its exit code is the number of texts that are still held.
const bool counted = [] {
  if (std::getenv(kCounts) == nullptr) return false;
  _exit(static_cast<int>(HeldDescriptors().size()));
}();

Scenario TwoVehicles() {
  Scenario scenario;
  scenario.area = "main";
  scenario.vehicles.resize(2);
  return scenario;
}

// Restarts as a service does that came back from an order, found no scan, and so starts again
// before it has settled.
[[noreturn]] void RestartUnsettled() {
  setenv(kCounts, "1", 1);
  ServiceFlags flags;
  flags.qos = GIVEWAY_QOS_SETS "/default.xml";
  flags.former_qos = HoldText("former", "<former/>");
  flags.go_on_from = HoldText("run", "state");
  flags.resume = Resumed{};
  const StopSignal stop;
  const auto live = [](const link::LinkOptions&, const std::function<void()>&) -> LifeEnd {
    return {0, NewFlags{{"--qos", HoldText("qos", "<qos/>")},
                        {"--former-qos", HoldText("former", "<former/>")},
                        {"--go-on-from", HoldText("run", "state")},
                        {"--resume", HoldText("resume", "")}}};
  };
  try {
    RunService(flags, TwoVehicles(), stop, live);
  } catch (const std::exception& error) {
    std::fputs(error.what(), stderr);
  }
  _exit(kNotRestarted);
}

// Each such restart left two descriptors more: a vehicle that finds no world restarts once a
// minute.
TEST(ServiceRun, OneThatRestartsBeforeItSettledKeepsOpenWhatTheNextOneIsGivenAlone) {
  ASSERT_FALSE(counted);
  const pid_t child = fork();
  if (child == 0) RestartUnsettled();
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 4) << "the four texts of its new flags";
}

}  // namespace
}  // namespace giveway
