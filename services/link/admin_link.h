// What an operator's orders come by and are answered by, of a vehicle or a world.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/types/admin.h"

namespace giveway::link {

// What the receiver reads of an answer: what is longer than the wire carries is cut. A seal must be
// of that.
AdminAnswer AsReceived(const AdminAnswer& answer);

class AdminLink {
 public:
  // The orders to this process that have come since the last call.
  virtual std::vector<AdminRequest> TakeAdminRequests() = 0;
  virtual void SendAnswer(const AdminAnswer& answer) = 0;
  // What the endpoints there are now run with; of those that are alike the first only.
  virtual std::vector<LiveValue> LiveQos() const = 0;
  // Gives the endpoints of a profile another deadline while they run, and those to come; one
  // without endpoints here is no fault. `deadline` in nanoseconds, or kInfiniteDuration. False if
  // the library refused.
  virtual bool SetDeadline(const std::string& profile, std::int64_t deadline) = 0;

 protected:
  ~AdminLink() = default;
};

}  // namespace giveway::link
