#include "services/runtime/state_writer.h"

#include <algorithm>
#include <utility>

#include "services/runtime/process.h"
#include "services/runtime/signals_blocked.h"
#include "services/types/check.h"

namespace giveway {

StateWriter::StateWriter(WriteState write) : write_(std::move(write)) {
  const SignalsBlocked blocked;
  thread_ = std::thread([this] { Run(); });
}

StateWriter::~StateWriter() { Finish(); }

void StateWriter::Write(std::string bytes) {
  {
    const std::scoped_lock lock(mutex_);
    GIVEWAY_CHECK(!closed_, bytes.size());
    next_ = std::move(bytes);
  }
  work_.notify_one();
}

std::optional<std::string> StateWriter::TakeOutcome() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(outcome_, std::nullopt);
}

Nanoseconds StateWriter::Longest() {
  const std::scoped_lock lock(mutex_);
  return longest_;
}

void StateWriter::Finish() {
  {
    const std::scoped_lock lock(mutex_);
    closed_ = true;
  }
  work_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void StateWriter::Run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    work_.wait(lock, [this] { return next_ || closed_; });
    if (!next_) return;
    const std::string bytes = *std::exchange(next_, std::nullopt);
    lock.unlock();
    const SteadyTime begun = SteadyNow();
    std::string outcome = write_(bytes);
    const Nanoseconds took = SteadyNow() - begun;
    lock.lock();
    outcome_ = std::move(outcome);
    longest_ = std::max(longest_, took);
  }
}

}  // namespace giveway
