#include "services/health/connection_desk.h"

#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "services/runtime/process.h"
#include "services/runtime/signals_blocked.h"

namespace giveway {
namespace {

using std::chrono::milliseconds;

constexpr Nanoseconds kGoodByeTime = milliseconds(100);
constexpr int kSlice_ms = 20;               // how soon what is over its time is closed
constexpr std::size_t kMostNewcomers = 64;  // not yet looked at

std::string AddressOf(int socket) {
  sockaddr_storage peer{};
  socklen_t size = sizeof peer;
  std::array<char, NI_MAXHOST> text{};
  if (getpeername(socket, reinterpret_cast<sockaddr*>(&peer), &size) != 0 ||
      getnameinfo(reinterpret_cast<sockaddr*>(&peer), size, text.data(), text.size(), nullptr, 0,
                  NI_NUMERICHOST) != 0) {
    return {};
  }
  std::string address = text.data();
  constexpr std::string_view kMapped = "::ffff:";
  if (address.starts_with(kMapped)) address.erase(0, kMapped.size());
  const bool is_here = address.starts_with("127.") || address == "::1";
  return is_here ? std::string(kThisMachine) : address;
}

// So that an answer is taken whole, however slowly the other side reads it.
void MakeRoomForAnswer(int socket) {
  constexpr int kAnswer = 128 * 1024;
  setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &kAnswer, sizeof kAnswer);
}

void LeaveUnblocked(int descriptor) {
  fcntl(descriptor, F_SETFL, fcntl(descriptor, F_GETFL) | O_NONBLOCK);
  fcntl(descriptor, F_SETFD, FD_CLOEXEC);
}

// The end of a header, or more than one may take.
bool IsWhole(const std::string& request) {
  return request.size() >= ConnectionDesk::kLongestRequest ||
         request.find("\r\n\r\n") != std::string::npos || request.find("\n\n") != std::string::npos;
}

}  // namespace

std::optional<std::size_t> WhoGivesWay(std::span<const Guest> guests, std::string_view address) {
  const auto oldest = [&](std::size_t places, auto is_meant) -> std::optional<std::size_t> {
    std::optional<std::size_t> found;
    std::size_t count = 0;
    for (std::size_t i = 0; i < guests.size(); ++i) {
      if (!is_meant(guests[i])) continue;
      ++count;
      if (!found || guests[i].since < guests[*found].since) found = i;
    }
    return count < places ? std::nullopt : found;
  };
  const auto same =
      oldest(kPlacesAnAddress, [&](const Guest& guest) { return guest.address == address; });
  if (same || address == kThisMachine) return same;
  return oldest(kPlacesOfOthers, [](const Guest& guest) { return guest.address != kThisMachine; });
}

ConnectionDesk::ConnectionDesk(Answer answer) : answer_(std::move(answer)) {
  std::array<int, 2> ends{-1, -1};
  // Without it newcomers wait for the end of a slice.
  [[maybe_unused]] const int failed = pipe2(ends.data(), O_NONBLOCK | O_CLOEXEC);
  wake_read_ = ends[0];
  wake_write_ = ends[1];
  const SignalsBlocked blocked;
  thread_ = std::thread(&ConnectionDesk::Serve, this);
}

ConnectionDesk::~ConnectionDesk() {
  ends_ = true;
  thread_.join();
  for (const Connection& connection : connections_) close(connection.socket);
  for (const int socket : newcomers_) close(socket);
  close(wake_read_);
  close(wake_write_);
}

void ConnectionDesk::Take(int socket) {
  const std::scoped_lock lock(mutex_);
  if (newcomers_.size() >= kMostNewcomers) {
    close(socket);
    return;
  }
  newcomers_.push_back(socket);
  const char news = 0;
  [[maybe_unused]] const ssize_t written = write(wake_write_, &news, 1);
}

void ConnectionDesk::Serve() {
  while (!ends_) {
    WaitForNews();
    std::vector<int> newcomers;
    {
      const std::scoped_lock lock(mutex_);
      newcomers.swap(newcomers_);
    }
    for (const int socket : newcomers) Admit(socket);
    for (std::size_t i = connections_.size(); i-- > 0;) {
      if (!Read(&connections_[i])) Drop(i);
    }
  }
}

// Or for the end of a slice.
void ConnectionDesk::WaitForNews() {
  std::vector<pollfd> watched{{.fd = wake_read_, .events = POLLIN, .revents = 0}};
  for (const Connection& connection : connections_) {
    watched.push_back({.fd = connection.socket, .events = POLLIN, .revents = 0});
  }
  poll(watched.data(), watched.size(), kSlice_ms);
  std::array<char, 64> news;
  while (read(wake_read_, news.data(), news.size()) > 0) {
  }
}

void ConnectionDesk::Admit(int socket) {
  LeaveUnblocked(socket);
  MakeRoomForAnswer(socket);
  Guest guest{AddressOf(socket), SteadyNow()};
  if (const auto leaves = WhoGivesWay(guests_, guest.address)) Drop(*leaves);
  connections_.push_back({socket, {}, guest.since + kRequestTime, false});
  guests_.push_back(std::move(guest));
  if (!Read(&connections_.back())) Drop(connections_.size() - 1);
}

// Once a turn: a client that sends without end gets no more of them than others.
bool ConnectionDesk::Read(Connection* connection) {
  if (SteadyNow() >= connection->until) return false;
  std::array<char, 2048> bytes;
  const ssize_t got = recv(connection->socket, bytes.data(), bytes.size(), 0);
  if (got < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
  if (got == 0) return false;
  if (connection->answered) return true;  // what it says beyond its request
  connection->request.append(bytes.data(), static_cast<std::size_t>(got));
  if (!IsWhole(connection->request)) return true;
  connection->request.resize(std::min(connection->request.size(), kLongestRequest));
  answer_(connection->socket, connection->request);
  // Closing over unread bytes would take the answer back.
  shutdown(connection->socket, SHUT_WR);
  connection->answered = true;
  connection->until = std::min(connection->until, SteadyNow() + kGoodByeTime);
  return true;
}

void ConnectionDesk::Drop(std::size_t index) {
  close(connections_[index].socket);
  connections_.erase(connections_.begin() + static_cast<std::ptrdiff_t>(index));
  guests_.erase(guests_.begin() + static_cast<std::ptrdiff_t>(index));
}

}  // namespace giveway
