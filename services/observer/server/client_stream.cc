#include "services/observer/server/client_stream.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "services/observer/server/socket_bounds.h"
#include "services/runtime/process.h"

namespace giveway {
namespace {

using std::chrono::milliseconds;

// A client that takes nothing for this long is gone, or might as well be.
constexpr Nanoseconds kWriteTime = std::chrono::seconds(5);
// And one that takes an answer by drops holds a thread.
constexpr Nanoseconds kAnswerTime = std::chrono::seconds(60);
constexpr std::size_t kPiece = 64UL << 10U;  // bytes given to the kernel at once
constexpr Nanoseconds kDrainTime = milliseconds(100);
constexpr Nanoseconds kSlice = milliseconds(50);  // how soon a server that stops is noticed

}  // namespace

ClientStream::ClientStream(int socket, const std::atomic<bool>& stops)
    : socket_(socket), stops_(stops), read_until_(SteadyNow() + kRequestTime) {
  BoundKernel(socket);
}

bool ClientStream::Wait(short what, SteadyTime until) const {
  while (!stops_ && SteadyNow() < until) {
    pollfd one{.fd = socket_, .events = what, .revents = 0};
    constexpr int kSlice_ms = static_cast<int>(kSlice / milliseconds(1));
    const int ready = poll(&one, 1, kSlice_ms);
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
  }
  return false;
}

bool ClientStream::is_readable() const { return Wait(POLLIN, read_until_); }
bool ClientStream::is_writable() const { return Wait(POLLOUT, SteadyNow() + kWriteTime); }

ssize_t ClientStream::read(char* to, std::size_t size) {
  const std::size_t most = std::min(size, kLongestRequest - taken_);
  if (most == 0 || !is_readable()) return -1;
  const ssize_t got = recv(socket_, to, most, 0);
  taken_ += static_cast<std::size_t>(std::max<ssize_t>(got, 0));
  return got;
}

// All of it, or an error: the library takes what was written of a page for the whole of it.
ssize_t ClientStream::write(const char* from, std::size_t size) {
  std::size_t written = 0;
  const SteadyTime until = SteadyNow() + kAnswerTime;
  while (written < size) {
    if (!Wait(POLLOUT, std::min(until, SteadyNow() + kWriteTime))) return -1;
    const std::size_t piece = std::min(size - written, kPiece);
    const ssize_t sent = send(socket_, from + written, piece, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && errno != EAGAIN && errno != EINTR) return -1;
    written += static_cast<std::size_t>(std::max<ssize_t>(sent, 0));
  }
  return static_cast<ssize_t>(size);
}

void ClientStream::Drain() {
  shutdown(socket_, SHUT_WR);
  std::array<char, 1024> unread;
  const SteadyTime until = SteadyNow() + kDrainTime;
  while (Wait(POLLIN, until) && recv(socket_, unread.data(), unread.size(), 0) > 0) {
  }
}

}  // namespace giveway
