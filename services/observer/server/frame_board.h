// The newest frame for any number of clients: one slot, never a queue. A slow client skips frames,
// and nothing waits for it.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "services/types/time.h"

namespace giveway {

class FrameBoard {
 public:
  using Text = std::shared_ptr<const std::string>;

  void Publish(std::string frame) {
    {
      const std::lock_guard lock(mutex_);
      newest_ = std::make_shared<const std::string>(std::move(frame));
      ++number_;
    }
    changed_.notify_all();
  }
  // No more frames come: releases all waiting clients.
  void Close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    changed_.notify_all();
  }
  bool IsClosed() const {
    const std::lock_guard lock(mutex_);
    return closed_;
  }

  // Of the newest frame; 0: there was none yet.
  std::uint64_t Number() const {
    const std::lock_guard lock(mutex_);
    return number_;
  }

  // The newest frame and its number once there is one other than `after`; null after `timeout`.
  std::pair<Text, std::uint64_t> Wait(std::uint64_t after, Nanoseconds timeout) const {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [&] { return closed_ || number_ != after; });
    if (closed_ || number_ == after) return {nullptr, after};
    return {newest_, number_};
  }

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  Text newest_;
  std::uint64_t number_ = 0;  // frames published so far
  bool closed_ = false;
};

}  // namespace giveway
