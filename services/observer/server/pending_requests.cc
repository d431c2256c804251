#include "services/observer/server/pending_requests.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string_view>
#include <utility>

#include "services/observer/server/socket_bounds.h"
#include "services/runtime/process.h"
#include "services/runtime/signals_blocked.h"

namespace giveway {
namespace {

constexpr int kSlice_ms = 20;  // how soon more of a request, or the end of its time, is noticed
constexpr std::size_t kMostNewcomers = PendingRequests::kMost;  // not yet looked at

// The end of a header, or more than one may take.
bool IsWhole(std::string_view request) {
  return request.size() >= kLongestRequest || request.find("\r\n\r\n") != std::string_view::npos ||
         request.find("\n\n") != std::string_view::npos;
}

}  // namespace

PendingRequests::PendingRequests(HandOn hand_on) : hand_on_(std::move(hand_on)) {
  std::array<int, 2> ends{-1, -1};
  // Without it newcomers wait for the end of a slice.
  [[maybe_unused]] const int failed = pipe2(ends.data(), O_NONBLOCK | O_CLOEXEC);
  wake_read_ = ends[0];
  wake_write_ = ends[1];
  const SignalsBlocked blocked;
  thread_ = std::thread(&PendingRequests::Serve, this);
}

PendingRequests::~PendingRequests() {
  ends_ = true;
  thread_.join();
  for (const Connection& connection : connections_) close(connection.socket);
  for (const int socket : newcomers_) close(socket);
  close(wake_read_);
  close(wake_write_);
}

void PendingRequests::Take(int socket) {
  const std::scoped_lock lock(mutex_);
  if (newcomers_.size() >= kMostNewcomers) {
    close(socket);
    return;
  }
  newcomers_.push_back(socket);
  const char news = 0;
  [[maybe_unused]] const ssize_t written = write(wake_write_, &news, 1);
}

void PendingRequests::Serve() {
  while (!ends_) {
    WaitForNews();
    Admit();
    std::vector<Connection> stay;
    for (Connection& connection : connections_) {
      if (!IsOver(&connection)) stay.push_back(connection);
    }
    connections_ = std::move(stay);
  }
}

// Or for the end of a slice. A part of a request is readable all the time: it is no news.
void PendingRequests::WaitForNews() {
  std::vector<pollfd> watched{{.fd = wake_read_, .events = POLLIN, .revents = 0}};
  for (const Connection& connection : connections_) {
    if (connection.has_begun) continue;
    watched.push_back({.fd = connection.socket, .events = POLLIN, .revents = 0});
  }
  poll(watched.data(), watched.size(), kSlice_ms);
  std::array<char, 64> news;
  while (read(wake_read_, news.data(), news.size()) > 0) {
  }
}

void PendingRequests::Admit() {
  std::vector<int> newcomers;
  {
    const std::scoped_lock lock(mutex_);
    newcomers.swap(newcomers_);
  }
  for (const int socket : newcomers) {
    connections_.push_back({.socket = socket, .until = SteadyNow() + kRequestTime});
    if (connections_.size() <= kMost) continue;
    close(connections_.front().socket);
    connections_.erase(connections_.begin());
  }
}

bool PendingRequests::IsOver(Connection* connection) {
  std::array<char, kLongestRequest> bytes;
  const ssize_t got = recv(connection->socket, bytes.data(), bytes.size(), MSG_PEEK | MSG_DONTWAIT);
  if (got > 0 && IsWhole({bytes.data(), static_cast<std::size_t>(got)})) {
    hand_on_(connection->socket);
    return true;
  }
  const bool is_open = got > 0 || (got < 0 && (errno == EAGAIN || errno == EINTR));
  connection->has_begun = got > 0;
  if (is_open && SteadyNow() < connection->until) return false;
  close(connection->socket);
  return true;
}

}  // namespace giveway
