// Takes in the connections of an HTTP server: reads of each what it asks, without waiting for any
// of them, and hands over whole requests. A client has one second for all of its request, two
// connections an address, and those of this machine have places that no other takes, so that its
// probe is answered whatever others hold open. Knows no HTTP but the end of its header.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "services/types/time.h"

namespace giveway {

// A client that has a place.
struct Guest {
  std::string address;  // numeric; of this machine: kThisMachine
  SteadyTime since{0};
};

inline constexpr std::string_view kThisMachine = "loopback";
inline constexpr std::size_t kPlacesAnAddress = 2;
inline constexpr std::size_t kPlacesOfOthers = 14;  // of all other machines together

// Which guest must go for a newcomer from that address: the one there longest, of the same address,
// or of all other machines where their places are taken. A guest that sends its request at once is
// answered before. Nothing: there is a place. Pure.
std::optional<std::size_t> WhoGivesWay(std::span<const Guest> guests, std::string_view address);

class ConnectionDesk {
 public:
  static constexpr Nanoseconds kRequestTime = std::chrono::seconds(1);
  static constexpr std::size_t kLongestRequest = 8192;  // bytes: a probe sends some hundred

  // Writes the answer to `request` into the socket and does not close it. On the desk's thread.
  using Answer = std::function<void(int socket, const std::string& request)>;

  explicit ConnectionDesk(Answer answer);
  // Closes what is open.
  ~ConnectionDesk();
  ConnectionDesk(const ConnectionDesk&) = delete;
  ConnectionDesk& operator=(const ConnectionDesk&) = delete;

  // Owns the socket from here on. From any thread; never waits.
  void Take(int socket);

 private:
  struct Connection {
    int socket = -1;
    std::string request;
    SteadyTime until{0};
    bool answered = false;  // and now only waits for the other side to close
  };

  void Serve();
  void WaitForNews();
  void Admit(int socket);
  bool Read(Connection* connection);  // false: it is over
  void Drop(std::size_t index);

  const Answer answer_;
  std::mutex mutex_;
  std::vector<int> newcomers_;  // guarded by mutex_
  int wake_read_ = -1;
  int wake_write_ = -1;
  std::atomic<bool> ends_{false};
  std::vector<Guest> guests_;  // the thread's own, as the next: one a connection
  std::vector<Connection> connections_;
  std::thread thread_;
};

}  // namespace giveway
