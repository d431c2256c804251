// Connections whose request has not come whole: they wait here and hold none of the threads that
// answer. Looks at what a client sent without taking it. Bounded in time and number.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "services/types/time.h"

namespace giveway {

class PendingRequests {
 public:
  // Beyond it the connection that is there longest is closed: one that sends its request at once is
  // answered, however many say nothing.
  static constexpr std::size_t kMost = 128;

  // Owns a socket whose request is whole. On the thread of this; must not wait.
  using HandOn = std::function<void(int socket)>;

  explicit PendingRequests(HandOn hand_on);
  // Closes what is open.
  ~PendingRequests();
  PendingRequests(const PendingRequests&) = delete;
  PendingRequests& operator=(const PendingRequests&) = delete;

  // Owns the socket from here on. From any thread; never waits.
  void Take(int socket);

 private:
  struct Connection {
    int socket = -1;
    SteadyTime until{0};
    bool has_begun = false;  // a part of its request is there
  };

  void Serve();
  void WaitForNews();
  void Admit();
  bool IsOver(Connection* connection);  // closed, or handed on

  const HandOn hand_on_;
  std::mutex mutex_;
  std::vector<int> newcomers_;  // guarded by mutex_
  int wake_read_ = -1;
  int wake_write_ = -1;
  std::atomic<bool> ends_{false};
  std::vector<Connection> connections_;  // the thread's own, the oldest first
  std::thread thread_;
};

}  // namespace giveway
