// How a pure module is given threads: as a function that runs a body over [0, count) in any order
// and in any number of pieces. The result must not depend on how it was cut.
#pragma once

#include <cstddef>
#include <functional>

namespace giveway {

using ParallelBody = std::function<void(std::size_t begin, std::size_t end)>;
// Calls the body on pieces that together are [0, count), each once, and returns when all are done.
using ParallelFor = std::function<void(std::size_t count, const ParallelBody& body)>;

// One piece, on the caller's thread.
inline void OnThisThread(std::size_t count, const ParallelBody& body) {
  if (count > 0) body(0, count);
}

}  // namespace giveway
