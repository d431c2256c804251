#include "services/health/heap_in_use.h"

#include <malloc.h>

#include "services/types/sanitizers.h"

namespace giveway {

std::optional<std::uint64_t> HeapInUse() {
#if defined(GIVEWAY_ADDRESS_SANITIZER) || defined(GIVEWAY_THREAD_SANITIZER)
  return std::nullopt;
#else
  const struct mallinfo2 heap = ::mallinfo2();
  const std::uint64_t bytes = heap.uordblks + heap.hblkhd;
  return bytes > 0 ? std::optional(bytes) : std::nullopt;
#endif
}

}  // namespace giveway
