// Log lines queued for a descriptor. Logging never waits for the reader of the log: a thread of the
// queue's own writes, one line at a time. What a full queue cannot take, and what cannot be
// written, is dropped, counted, and reported in its place in the log as soon as the reader reads
// again.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "services/types/time.h"

namespace giveway {

class LogQueue {
 public:
  // Makes the line that reports how many were dropped.
  using Notice = std::function<std::string(std::uint64_t dropped)>;

  // `descriptor` outlives the queue. At most `most_bytes` wait, besides the line being written.
  LogQueue(int descriptor, std::size_t most_bytes);
  // Waits until all is written: for a queue whose reader may stop use Flush, and keep the queue.
  ~LogQueue();
  LogQueue(const LogQueue&) = delete;
  LogQueue& operator=(const LogQueue&) = delete;

  void SetNotice(Notice notice);
  // Any thread's; never waits for the reader.
  void Push(std::string line);
  // True if everything pushed so far was written, or dropped, within `limit`.
  bool Flush(Nanoseconds limit);
  // Lines dropped so far, reported or not.
  std::uint64_t Dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  struct Line {
    std::string text;
    std::uint64_t reports = 0;  // how many dropped lines this one reports; 0: an ordinary line
  };

  void Run();
  bool HasWork() const;
  bool MakeNotice(std::size_t bytes_after_it);
  bool Write(const std::string& text) const;

  const int descriptor_;
  const std::size_t most_bytes_;
  std::atomic<std::uint64_t> dropped_{0};
  std::mutex mutex_;  // guards all that follows; never held while a line is written
  std::condition_variable work_;
  std::condition_variable drained_;
  Notice notice_;
  std::deque<Line> lines_;
  std::size_t bytes_ = 0;
  std::uint64_t unreported_ = 0;
  bool writing_ = false;
  bool fails_ = false;  // the last write did: a notice would fail as well
  bool closed_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace giveway
