#include "services/fleetctl/record/sample_ring.h"

#include <gtest/gtest.h>

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

link::RawSample SampleAt(Nanoseconds reception, const std::string& bytes) {
  return {
      .topic = 0, .reception_ns = static_cast<std::uint64_t>(reception.count()), .bytes = bytes};
}

TEST(SampleRing, KeepsTheLastSeconds) {
  SampleRing ring(2);
  for (int second = 1; second <= 10; ++second) {
    ring.Add(SampleAt(seconds(second), "x"), seconds(second));
  }
  ASSERT_EQ(ring.Samples().size(), 3U);
  EXPECT_EQ(ring.Samples().front().reception_ns, 8'000'000'000U);
  EXPECT_EQ(ring.Dropped(), 0U);
}

// Nothing that came after the step was too old until the memory was full; then all of it was, and
// more was dropped than there was.
TEST(SampleRing, KeepsTheLastSecondsAfterTheClockWasSetBack) {
  SampleRing ring(2);
  ring.Add(SampleAt(seconds(100), "x"), seconds(1));
  const std::string large(16U << 20U, 'x');
  for (int tenth = 0; tenth < 100; ++tenth) {
    const milliseconds since_step(100 * tenth);
    ring.Add(SampleAt(seconds(10) + since_step, large), seconds(1) + since_step);
  }
  ASSERT_EQ(ring.Samples().size(), 21U);
  EXPECT_EQ(ring.Samples().front().reception_ns, 17'900'000'000U);
  EXPECT_EQ(ring.Dropped(), 0U);
}

TEST(SampleRing, TakesBoundedMemoryAndSaysWhatHadToGo) {
  SampleRing ring(1e6);
  const std::string large(64U << 20U, 'x');
  for (int n = 0; n < 10; ++n) {
    ring.Add({.topic = 0, .reception_ns = 1, .bytes = large}, seconds(1));
  }
  EXPECT_LE(ring.Samples().size(), 8U);
  EXPECT_GT(ring.Dropped(), 0U);
}

TEST(SampleRing, ASampleThatIsTooLargeForItLeavesItEmpty) {
  SampleRing ring(2);
  ring.Add({.topic = 0, .bytes = std::string(SampleRing::kMostBytes, 'x')}, seconds(1));
  EXPECT_TRUE(ring.Samples().empty());
  ring.Add({.topic = 0, .bytes = "x"}, seconds(9));
  EXPECT_EQ(ring.Samples().size(), 1U);
}

}  // namespace
}  // namespace giveway::fleetctl
