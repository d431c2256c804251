// What a client may take of the page's server; and what the kernel keeps for a client of a live
// stream, whatever protocol it speaks.
#pragma once

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <cstddef>

#include "services/types/time.h"

namespace giveway {

inline constexpr std::size_t kLongestRequest = 8192;  // bytes: a browser sends some hundred
inline constexpr Nanoseconds kRequestTime = std::chrono::seconds(2);

// The kernel would keep megabytes for a slow client, and it would be shown frames of a minute ago:
// it is writable only while little waits to be sent. And a client whose machine is gone ends, also
// after we have closed.
inline void BoundKernel(int socket) {
  const int most_unsent = 16 << 10;  // bytes
  const int most_unheard_ms = 10'000;
  setsockopt(socket, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &most_unsent, sizeof(most_unsent));
  setsockopt(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, &most_unheard_ms, sizeof(most_unheard_ms));
}

}  // namespace giveway
