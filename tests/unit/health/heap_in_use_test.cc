#include "services/health/heap_in_use.h"

#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

#include "services/types/sanitizers.h"

namespace giveway {
namespace {

#if defined(GIVEWAY_ADDRESS_SANITIZER) || defined(GIVEWAY_THREAD_SANITIZER)
constexpr bool kHasAnother = true;
#else
constexpr bool kHasAnother = false;
#endif

using Pieces = std::vector<std::unique_ptr<char[]>>;

Pieces Allocated(std::size_t count, std::size_t bytes) {
  Pieces pieces(count);
  for (auto& piece : pieces) piece = std::make_unique<char[]>(bytes);
  return pieces;
}

TEST(HeapInUse, IsNotKnownOfAnotherAllocator) { EXPECT_EQ(HeapInUse().has_value(), !kHasAnother); }

TEST(HeapInUse, GrowsByWhatIsAllocatedAndFallsByWhatIsFreed) {
  const auto before = HeapInUse();
  if (kHasAnother) GTEST_SKIP() << "not the C library's allocator";
  ASSERT_TRUE(before);
  constexpr std::size_t kBytes = 4 << 20;
  for (const std::size_t count : {std::size_t{1}, std::size_t{4096}}) {  // mapped, and of an arena
    Pieces pieces = Allocated(count, kBytes / count);
    EXPECT_GE(*HeapInUse(), *before + kBytes) << count;
    pieces.clear();
    EXPECT_LT(*HeapInUse(), *before + kBytes / 4) << count;
  }
}

TEST(HeapInUse, CountsWhatOtherThreadsAllocated) {
  const auto before = HeapInUse();
  if (kHasAnother) GTEST_SKIP() << "not the C library's allocator";
  ASSERT_TRUE(before);
  Pieces pieces;
  std::thread([&pieces] { pieces = Allocated(4096, 1024); }).join();
  EXPECT_GE(*HeapInUse(), *before + 4096 * 1024);
}

}  // namespace
}  // namespace giveway
