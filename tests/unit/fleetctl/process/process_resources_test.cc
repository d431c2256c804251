#include "services/fleetctl/process/process_resources.h"

#include <gtest/gtest.h>

#include <string>

namespace giveway::fleetctl {
namespace {

constexpr double kTicksPerSecond = 100;

// proc(5): the 14th and 15th number are utime and stime.
std::string StatOf(const std::string& name) {
  return "4711 (" + name +
         ") S 1 4711 4711 0 -1 4194304 900 0 7 0 250 50 33 44 20 0 9 0 12345 1000000 2000 "
         "18446744073709551615 1 1 0 0 0 0\n";
}

constexpr const char* kStatus =
    "Name:\tgiveway-vehicle\nVmHWM:\t   99999 kB\nVmRSS:\t   20480 kB\nRssAnon:\t    8192 kB\n"
    "RssFile:\t   12288 kB\nRssShmem:\t       0 kB\nThreads:\t9\n";

TEST(ProcessResources, AreReadFromStatAndStatus) {
  const auto resources = ParseResources(StatOf("giveway-vehicle"), kStatus, kTicksPerSecond);
  ASSERT_TRUE(resources);
  EXPECT_DOUBLE_EQ(resources->cpu_s, 3.0);
  EXPECT_EQ(resources->resident_bytes, 20U << 20U);
  EXPECT_EQ(resources->private_bytes, 8U << 20U);
  EXPECT_EQ(resources->threads, 9U);
}

TEST(ProcessResources, ANameMayHoldBracketsAndSpaces) {
  const auto resources = ParseResources(StatOf("a) R 1 2 (b"), kStatus, kTicksPerSecond);
  ASSERT_TRUE(resources);
  EXPECT_DOUBLE_EQ(resources->cpu_s, 3.0);
}

// The process ended before or while its file was read.
TEST(ProcessResources, HalfAFileIsNothing) {
  EXPECT_FALSE(ParseResources("", kStatus, kTicksPerSecond));
  const std::string whole = StatOf("giveway-vehicle");
  EXPECT_FALSE(ParseResources(whole.substr(0, whole.find(" 50 33")), kStatus, kTicksPerSecond));
}

// A zombie: ended, but not waited for yet.
TEST(ProcessResources, WithoutMemoryThereIsStillTheTime) {
  const auto resources = ParseResources(StatOf("sh"), "Name:\tsh\nThreads:\t1\n", kTicksPerSecond);
  ASSERT_TRUE(resources);
  EXPECT_EQ(resources->resident_bytes, 0U);
  EXPECT_EQ(resources->threads, 1U);
}

}  // namespace
}  // namespace giveway::fleetctl
