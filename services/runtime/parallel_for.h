// The threads given to pure modules (services/types/parallel.h): a fixed pool, and the caller works
// too. Cuts and hands out work; knows nothing of what it is.
#pragma once

#include <memory>

#include "services/types/parallel.h"

namespace giveway {

class ParallelPool {
 public:
  // `threads` counts the caller's: 0 and 1 start none.
  explicit ParallelPool(unsigned threads);
  // Waits for the workers to end. No call may be in progress.
  ~ParallelPool();
  ParallelPool(const ParallelPool&) = delete;
  ParallelPool& operator=(const ParallelPool&) = delete;

  // Not to be used beyond the pool's life. Bodies must not throw. A call from inside a body, or
  // from a second thread while another's is in progress, runs in one piece on its own thread.
  ParallelFor Function();

 private:
  class Workers;
  std::unique_ptr<Workers> workers_;  // null where there are none
};

}  // namespace giveway
