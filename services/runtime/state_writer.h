// Writes the state of a process from a thread of its own: the loop that hands it over waits neither
// for a disk, which may stall for seconds, nor until a long state is put into words. Of states that
// come while one is being written only the newest is kept. What is written, how and where, is up to
// the function it is given.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "services/runtime/process.h"
#include "services/runtime/signals_blocked.h"
#include "services/types/check.h"
#include "services/types/time.h"

namespace giveway {

template <typename State = std::string>
class StateWriter {
 public:
  // Writes the state. Empty if it is written, else why not. On the thread of the writer.
  using WriteState = std::function<std::string(const State& state)>;

  explicit StateWriter(WriteState write) : write_(std::move(write)) {
    const SignalsBlocked blocked;
    thread_ = std::thread([this] { Run(); });
  }
  // As Finish.
  ~StateWriter() { Finish(); }
  StateWriter(const StateWriter&) = delete;
  StateWriter& operator=(const StateWriter&) = delete;

  // Never waits for the disk. Not after Finish.
  void Write(State state) {
    {
      const std::scoped_lock lock(mutex_);
      GIVEWAY_CHECK(!closed_, "finished");
      next_ = std::move(state);
    }
    work_.notify_one();
  }
  // What the last write that has ended returned, once.
  std::optional<std::string> TakeOutcome() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(outcome_, std::nullopt);
  }
  // How long the longest write took that has ended.
  Nanoseconds Longest() {
    const std::scoped_lock lock(mutex_);
    return longest_;
  }
  // Processor time of the last write that has ended.
  Nanoseconds LastCost() {
    const std::scoped_lock lock(mutex_);
    return last_cost_;
  }
  // Waits until the newest state is written: nothing is written afterwards.
  void Finish() {
    {
      const std::scoped_lock lock(mutex_);
      closed_ = true;
    }
    work_.notify_one();
    if (thread_.joinable()) thread_.join();
  }

 private:
  void Run() {
    std::unique_lock lock(mutex_);
    for (;;) {
      work_.wait(lock, [this] { return next_ || closed_; });
      if (!next_) return;
      const State state = *std::exchange(next_, std::nullopt);
      lock.unlock();
      const SteadyTime begun = SteadyNow();
      const Nanoseconds spent = ThreadTimeNow();
      std::string outcome = write_(state);
      const Nanoseconds took = SteadyNow() - begun;
      lock.lock();
      outcome_ = std::move(outcome);
      last_cost_ = ThreadTimeNow() - spent;
      longest_ = std::max(longest_, took);
    }
  }

  const WriteState write_;
  std::mutex mutex_;  // guards all that follows; never held while a state is written
  std::condition_variable work_;
  std::optional<State> next_;
  std::optional<std::string> outcome_;
  Nanoseconds last_cost_{0};
  Nanoseconds longest_{0};
  bool closed_ = false;
  std::thread thread_;
};

}  // namespace giveway
