// Writes the state of a process from a thread of its own: the loop that hands it over never waits
// for a disk, which may stall for seconds. Of states that come while one is being written only the
// newest is kept. What is written, and where, is up to the function it is given.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "services/types/time.h"

namespace giveway {

class StateWriter {
 public:
  // Writes the bytes. Empty if they are written, else why not. On the thread of the writer.
  using WriteState = std::function<std::string(const std::string& bytes)>;

  explicit StateWriter(WriteState write);
  // As Finish.
  ~StateWriter();
  StateWriter(const StateWriter&) = delete;
  StateWriter& operator=(const StateWriter&) = delete;

  // Never waits for the disk. Not after Finish.
  void Write(std::string bytes);
  // What the last write that has ended returned, once.
  std::optional<std::string> TakeOutcome();
  // How long the longest write took that has ended.
  Nanoseconds Longest();
  // Waits until the newest state is written: nothing is written afterwards.
  void Finish();

 private:
  void Run();

  const WriteState write_;
  std::mutex mutex_;  // guards all that follows; never held while a state is written
  std::condition_variable work_;
  std::optional<std::string> next_;
  std::optional<std::string> outcome_;
  Nanoseconds longest_{0};
  bool closed_ = false;
  std::thread thread_;
};

}  // namespace giveway
