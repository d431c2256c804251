// The heap that a process uses, as its allocator counts it. Only the process itself can ask: from
// outside, resident memory is visible, which an allocator may keep after it is freed.
#pragma once

#include <cstdint>
#include <optional>

namespace giveway {

// Bytes of the C library's allocator, all its arenas and large mappings, that are not free; what a
// thread keeps to give out again counts as used. Nothing where another allocator serves this
// process, as with sanitizers. Locks one arena after the other, and walks through what is free in
// it: not for every tick.
std::optional<std::uint64_t> HeapInUse();

}  // namespace giveway
