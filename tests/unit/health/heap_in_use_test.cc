#include "services/health/heap_in_use.h"

#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

namespace giveway {
namespace {

using Pieces = std::vector<std::unique_ptr<char[]>>;

Pieces Allocated(std::size_t count, std::size_t bytes) {
  Pieces pieces(count);
  for (auto& piece : pieces) piece = std::make_unique<char[]>(bytes);
  return pieces;
}

// With another allocator, as with sanitizers, there is nothing to ask.
TEST(HeapInUse, GrowsByWhatIsAllocatedAndFallsByWhatIsFreed) {
  const auto before = HeapInUse();
  if (!before) GTEST_SKIP() << "not the C library's allocator";
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
  if (!before) GTEST_SKIP() << "not the C library's allocator";
  Pieces pieces;
  std::thread([&pieces] { pieces = Allocated(4096, 1024); }).join();
  EXPECT_GE(*HeapInUse(), *before + 4096 * 1024);
}

}  // namespace
}  // namespace giveway
