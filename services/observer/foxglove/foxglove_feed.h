// The samples that clients of Foxglove subscribe to, from the fleet to their server. Takes part in
// the domain only while a client subscribes: until then it costs neither the observer nor the fleet
// anything.
#pragma once

#include <memory>
#include <string>

#include "services/link/raw_link.h"
#include "services/observer/foxglove/foxglove_server.h"
#include "services/types/time.h"

namespace giveway {

// Every topic that is recorded, described as in a recording.
std::vector<FoxgloveChannel> FoxgloveChannels();

class FoxgloveFeed {
 public:
  // Listens. Throws ServerError.
  FoxgloveFeed(link::LinkOptions fleet, FoxgloveOptions server);

  // To be called again and again: opens and closes what is to be read, and passes on what came.
  void Turn(SteadyTime now);
  FoxgloveFigures Figures() const { return server_.Figures(); }

 private:
  void Open(std::uint64_t wanted, SteadyTime now);
  void RetryAfter(const std::exception& error, SteadyTime now);

  const link::LinkOptions fleet_;
  FoxgloveServer server_;
  std::unique_ptr<link::RawLink> link_;
  std::uint64_t open_ = 0;    // bits of the topics that are read
  SteadyTime wanted_at_{0};   // of the last turn with a subscription
  SteadyTime not_before_{0};  // of another try, after one failed
};

}  // namespace giveway
