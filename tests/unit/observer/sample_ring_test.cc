#include "services/fleetctl/record/sample_ring.h"

#include <gtest/gtest.h>

namespace giveway::fleetctl {
namespace {

TEST(SampleRing, KeepsTheLastSecondsByReception) {
  SampleRing ring(2);
  for (std::uint64_t second = 1; second <= 10; ++second) {
    ring.Add({.topic = 0, .source_ns = 0, .reception_ns = second * 1'000'000'000, .bytes = "x"});
  }
  ASSERT_EQ(ring.Samples().size(), 3U);
  EXPECT_EQ(ring.Samples().front().reception_ns, 8'000'000'000U);
  EXPECT_EQ(ring.Dropped(), 0U);
}

TEST(SampleRing, TakesBoundedMemoryAndSaysWhatHadToGo) {
  SampleRing ring(1e6);
  const std::string large(64U << 20U, 'x');
  for (int n = 0; n < 10; ++n) ring.Add({.topic = 0, .reception_ns = 1, .bytes = large});
  EXPECT_LE(ring.Samples().size(), 8U);
  EXPECT_GT(ring.Dropped(), 0U);
}

}  // namespace
}  // namespace giveway::fleetctl
