#include "services/fleetctl/process/process_resources.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <string>

namespace giveway::fleetctl {
namespace {

constexpr MachineUnits kUnits{.ticks_per_s = 100, .page_bytes = 4096};

// proc(5): the 14th and 15th field are utime and stime, the 20th is the number of threads.
std::string StatOf(const std::string& name) {
  return "4711 (" + name +
         ") S 1 4711 4711 0 -1 4194304 900 0 7 0 250 50 33 44 20 0 9 0 12345 1000000 2000 "
         "18446744073709551615 1 1 0 0 0 0\n";
}

// Pages: all, resident, of that in files or shared memory, and others.
constexpr const char* kStatm = "30000 5120 3072 40 0 9000 0\n";

TEST(ProcessResources, AreReadFromStatAndStatm) {
  const auto resources = ParseResources(StatOf("giveway-vehicle"), kStatm, kUnits);
  ASSERT_TRUE(resources);
  EXPECT_DOUBLE_EQ(resources->cpu_s, 3.0);
  EXPECT_EQ(resources->resident_bytes, 20U << 20U);
  EXPECT_EQ(resources->private_bytes, 8U << 20U);
  EXPECT_EQ(resources->threads, 9U);
}

TEST(ProcessResources, ANameMayHoldBracketsAndSpaces) {
  const auto resources = ParseResources(StatOf("a) R 1 2 (b"), kStatm, kUnits);
  ASSERT_TRUE(resources);
  EXPECT_DOUBLE_EQ(resources->cpu_s, 3.0);
}

// The process ended before or while its file was read.
TEST(ProcessResources, HalfAFileIsNothing) {
  EXPECT_FALSE(ParseResources("", kStatm, kUnits));
  const std::string whole = StatOf("giveway-vehicle");
  EXPECT_FALSE(ParseResources(whole.substr(0, whole.find(" 50 33")), kStatm, kUnits));
}

// A zombie: ended, but not waited for yet.
TEST(ProcessResources, WithoutMemoryThereIsStillTheTime) {
  const auto resources = ParseResources(StatOf("sh"), "", kUnits);
  ASSERT_TRUE(resources);
  EXPECT_DOUBLE_EQ(resources->cpu_s, 3.0);
  EXPECT_EQ(resources->resident_bytes, 0U);
  EXPECT_EQ(resources->threads, 9U);
}

TEST(ProcessResources, OfThisProcessGrowByADescriptorThatIsOpened) {
  const auto before = ReadResources(::getpid());
  ASSERT_TRUE(before);
  EXPECT_GE(before->threads, 1U);
  EXPECT_GT(before->resident_bytes, before->private_bytes);
  EXPECT_GT(before->private_bytes, 0U);
  const int more = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ASSERT_GE(more, 0);
  EXPECT_EQ(ReadResources(::getpid())->descriptors, before->descriptors + 1);
  ::close(more);
  EXPECT_EQ(ReadResources(::getpid())->descriptors, before->descriptors);
}

}  // namespace
}  // namespace giveway::fleetctl
