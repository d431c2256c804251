// /livez, /readyz and /metrics over HTTP on one port, and the client that asks for them. Its
// threads only ever read what `HealthPages` gives them; whatever a client does, no loop waits for
// it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "services/health/health.h"

namespace giveway {

// The pages, made again for each request, on a thread of the server.
struct HealthPages {
  std::function<Reasons()> not_live;
  std::function<Reasons()> not_ready;
  std::function<std::string()> metrics;
};

class HealthServer {
 public:
  // Listens from here on. Throws InputError, with a remedy, where it cannot.
  HealthServer(const std::string& address, std::uint16_t port, const HealthPages& pages);
  // Closes the port. Waits for clients a moment at most: slow ones are dropped.
  ~HealthServer();
  HealthServer(const HealthServer&) = delete;
  HealthServer& operator=(const HealthServer&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// For images without an HTTP client: asks the service that listens there for "live", "ready" or
// "metrics", prints the answer. 0: yes, 1: no, 2: no answer, stderr says where.
int AskHealth(const std::string& address, std::uint16_t port, const std::string& what);

}  // namespace giveway
