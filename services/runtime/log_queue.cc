#include "services/runtime/log_queue.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>
#include <utility>

#include "services/runtime/signals_blocked.h"

namespace giveway {
namespace {

std::thread WithoutSignals(std::function<void()> work) {
  const SignalsBlocked blocked;
  return std::thread(std::move(work));
}

}  // namespace

LogQueue::LogQueue(int descriptor, std::size_t most_bytes)
    : descriptor_(descriptor),
      most_bytes_(most_bytes),
      thread_(WithoutSignals([this] { Run(); })) {}

LogQueue::~LogQueue() {
  {
    const std::scoped_lock lock(mutex_);
    closed_ = true;
  }
  work_.notify_one();
  thread_.join();
}

void LogQueue::SetNotice(Notice notice) {
  const std::scoped_lock lock(mutex_);
  notice_ = std::move(notice);
}

void LogQueue::Push(std::string line) {
  {
    const std::scoped_lock lock(mutex_);
    const bool fits = bytes_ + line.size() <= most_bytes_;
    if (!fits || (unreported_ > 0 && !fails_ && !MakeNotice(line.size()))) {
      ++unreported_;
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    bytes_ += line.size();
    lines_.push_back({std::move(line)});
  }
  work_.notify_one();
}

bool LogQueue::Flush(Nanoseconds limit) {
  std::unique_lock lock(mutex_);
  return drained_.wait_for(lock, limit, [this] { return !writing_ && !HasWork(); });
}

bool LogQueue::HasWork() const { return !lines_.empty() || (unreported_ > 0 && !fails_); }

// False if it does not fit before a line of so many bytes.
bool LogQueue::MakeNotice(std::size_t bytes_after_it) {
  std::string text = notice_ ? notice_(unreported_) : std::string();
  if (bytes_ + text.size() + bytes_after_it > most_bytes_) return false;
  bytes_ += text.size();
  lines_.push_back({std::move(text), std::exchange(unreported_, 0)});
  return true;
}

void LogQueue::Run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    work_.wait(lock, [this] { return HasWork() || closed_; });
    if (!HasWork()) return;
    if (lines_.empty()) MakeNotice(0);
    const Line line = std::move(lines_.front());
    lines_.pop_front();
    bytes_ -= line.text.size();
    writing_ = true;
    lock.unlock();
    const bool written = Write(line.text);
    lock.lock();
    writing_ = false;
    fails_ = !written;
    if (!written) {
      unreported_ += line.reports > 0 ? line.reports : 1;
      if (line.reports == 0) dropped_.fetch_add(1, std::memory_order_relaxed);
    }
    if (!HasWork()) drained_.notify_all();
  }
}

// As long as the reader takes. False if the descriptor refuses it: a full disk, a closed pipe.
bool LogQueue::Write(const std::string& text) const {
  std::string_view bytes = text;
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (written < 0 && errno == EAGAIN) {  // another process made it non-blocking
      pollfd room{descriptor_, POLLOUT, 0};
      ::poll(&room, 1, -1);
    } else if (written == 0 || errno != EINTR) {
      return false;
    }
  }
  return true;
}

}  // namespace giveway
