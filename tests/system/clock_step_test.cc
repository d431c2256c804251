// The library that steps a process's system clock, preloaded into this program: it runs itself
// again.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <semaphore.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <functional>
#include <string>

#include "services/fleetctl/soak/host_faults/steppable_clock.h"

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr unsigned kHangs_s = 20;  // a shift of an hour, forth or back, is far beyond that

// The exit code of a test of this program whose system clock is stepped.
int RunStepped(const std::string& test, std::int64_t offset_s) {
  const std::string file =
      std::filesystem::temp_directory_path() / fmt::format("clock-step-{}", ::getpid());
  SteppableClock clock(file);
  clock.Step(offset_s);
  std::string line = "STEPPED=1";
  for (const std::string& variable : clock.Environment()) line += " " + variable;
  line += " " + std::filesystem::read_symlink("/proc/self/exe").string() +
          " --gtest_filter=" + test + " >&2";
  const int code = std::system(line.c_str());
  EXPECT_GT(clock.Shifted(), 0U) << "the library was not loaded";
  std::filesystem::remove(file);
  return code;
}

// How long `wait` takes until a moment of the system clock 100 ms ahead.
steady_clock::duration TimeOf(const std::function<void(const timespec&)>& wait) {
  timespec until{};
  ::clock_gettime(CLOCK_REALTIME, &until);
  until.tv_nsec += 100'000'000;
  if (until.tv_nsec >= 1'000'000'000) {
    until.tv_nsec -= 1'000'000'000;
    ++until.tv_sec;
  }
  const auto start = steady_clock::now();
  wait(until);
  return steady_clock::now() - start;
}

// In a process whose clock is stepped: alarm() ends one that hangs.
TEST(ClockStep, WaitsLastAsLongAsTheySay) {
  if (std::getenv("STEPPED") == nullptr) {
    for (const std::int64_t offset_s : {3600, -3600}) {
      EXPECT_EQ(RunStepped("ClockStep.WaitsLastAsLongAsTheySay", offset_s), 0) << offset_s;
    }
    return;
  }
  ::alarm(kHangs_s);
  pthread_mutex_t held = PTHREAD_MUTEX_INITIALIZER;  // by this thread: never free
  pthread_mutex_t mine = PTHREAD_MUTEX_INITIALIZER;
  pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
  sem_t semaphore;
  ASSERT_EQ(::pthread_mutex_lock(&held), 0);
  ASSERT_EQ(::pthread_mutex_lock(&mine), 0);
  ASSERT_EQ(::sem_init(&semaphore, 0, 0), 0);
  EXPECT_GE(TimeOf([&](const timespec& until) {
              EXPECT_EQ(::pthread_mutex_timedlock(&held, &until), ETIMEDOUT);
            }),
            milliseconds(90));
  EXPECT_GE(TimeOf([&](const timespec& until) {
              EXPECT_EQ(::pthread_cond_timedwait(&condition, &mine, &until), ETIMEDOUT);
            }),
            milliseconds(90));
  EXPECT_GE(TimeOf([&](const timespec& until) {
              EXPECT_EQ(::sem_timedwait(&semaphore, &until), -1);
              EXPECT_EQ(errno, ETIMEDOUT);
            }),
            milliseconds(90));
}

}  // namespace
}  // namespace giveway::fleetctl
