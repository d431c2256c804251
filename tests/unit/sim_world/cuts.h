// Work divided into pieces and done in an unlikely order, as by threads.
#pragma once

#include "services/types/parallel.h"

namespace giveway::sim {

inline ParallelFor InPiecesFromTheBack(std::size_t pieces) {
  return [pieces](std::size_t count, const ParallelBody& body) {
    for (std::size_t i = pieces; i-- > 0;) {
      const std::size_t begin = count * i / pieces;
      const std::size_t end = count * (i + 1) / pieces;
      if (begin != end) body(begin, end);
    }
  };
}

}  // namespace giveway::sim
