// The Foxglove WebSocket protocol on one port: channels are advertised, and samples go to the
// clients that subscribe to them. One thread of its own serves all; a client that is slow skips
// samples, and the fleet never waits for it. Takes nothing from clients but subscriptions.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "services/link/raw_link.h"
#include "services/observer/foxglove/foxglove_messages.h"

namespace giveway {

struct FoxgloveFigures {
  int clients = 0;
  std::uint64_t refused = 0;  // connections and messages
};

struct FoxgloveOptions {
  std::string address;
  std::uint16_t port = 0;
  std::string name;                       // of the fleet, for people
  std::vector<std::string> host_names;    // in addition to localhost and addresses
  std::vector<FoxgloveChannel> channels;  // ids are places in link::RawTopics(), and one
};

class FoxgloveServer {
 public:
  static constexpr int kMostClients = 16;

  // Listens from here on. Throws ServerError.
  explicit FoxgloveServer(FoxgloveOptions options);
  // Closes the port and the clients' connections.
  ~FoxgloveServer();
  FoxgloveServer(const FoxgloveServer&) = delete;
  FoxgloveServer& operator=(const FoxgloveServer&) = delete;

  // A bit for each place in link::RawTopics() that a client subscribes to.
  std::uint64_t Wanted() const;
  // To the clients that subscribe. Of topics in `kept`, a set of bits, the newest samples also go
  // to clients that subscribe later. Never waits.
  void Publish(std::vector<link::RawSample> samples, std::uint64_t kept);
  // What was kept is out of date: the fleet is no longer read.
  void ForgetKept();
  FoxgloveFigures Figures() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace giveway
