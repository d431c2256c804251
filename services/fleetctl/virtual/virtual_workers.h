// Runs many pieces of work on a few threads: handed out one by one, so that no thread waits for
// another.
#pragma once

#include <cstdint>
#include <functional>

namespace giveway::fleetctl {

// Calls `work` with 0 to count - 1, each once, on `jobs` threads, or on as many as can be started;
// throws if not even one can. `work` locks shared data itself. `progress` is called from time to
// time on the caller's thread. If it returns false, started work is completed and no more is
// started. Rethrows what `work` threw last.
void RunOnThreads(std::uint64_t count, std::uint32_t jobs,
                  const std::function<void(std::uint64_t)>& work,
                  const std::function<bool()>& progress);

}  // namespace giveway::fleetctl
