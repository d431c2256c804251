#include "services/vehicle_node/asking.h"

#include <chrono>

#include "services/auth/digest.h"
#include "services/runtime/process.h"

namespace giveway {
namespace {

constexpr Nanoseconds kAskAgain =
    std::chrono::seconds(1);  // a world forgets a request that is not repeated

}  // namespace

Asking::Asking(link::DriveLink* link, const Clock* clock, VehicleId wanted,
               const std::optional<SessionId>& session)
    : link_(*link), clock_(*clock) {
  request_.wanted = wanted;
  if (session) {
    request_.session = *session;
  } else {
    for (std::uint32_t& number : request_.secret) number = RandomNonZero();
    request_.session = auth::SessionOf(request_.secret);
  }
  Ask();
}

void Asking::AskAgainIfDue() {
  if (clock_.Now() >= again_) Ask();
}

bool Asking::IsFinal(const RosterEntry& entry) {
  answered_ = true;
  if (!entry.accepted && entry.waiting) {
    waits_for_ = "the world lets it wait: " + entry.reason;
    LogWarning(waits_for_);
  }
  return entry.accepted || !entry.waiting;
}

void Asking::Ask() {
  link_.SendJoin(request_);
  again_ = clock_.Now() + kAskAgain;
}

}  // namespace giveway
