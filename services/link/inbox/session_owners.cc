#include "services/link/inbox/session_owners.h"

#include <algorithm>

#include "services/auth/digest.h"

namespace giveway::link {

SessionOwners::Verdict SessionOwners::MayAsk(const JoinRequest& request, std::uint64_t participant,
                                             std::uint64_t writer, SteadyTime now,
                                             const std::function<bool(std::uint64_t)>& left) {
  const auto known = sessions_.find(request.session);
  if (known != sessions_.end()) {
    Owner& owner = known->second;
    if (owner.participant != participant) {
      const Nanoseconds patience = HasPlace(request.session) ? kSilence : kSilenceOfAWaiting;
      if (!left(owner.writer) && now - owner.heard <= patience) return Verdict::kOfAnother;
      --counts_[owner.participant];
      ++counts_[participant];
    }
    owner = {participant, writer, now};
    return Verdict::kYes;
  }
  const auto count = counts_.find(participant);
  if (count != counts_.end() && count->second >= kMostOfOne) return Verdict::kTooMany;
  ++counts_[participant];
  sessions_.emplace(request.session, Owner{participant, writer, now});
  oldest_.push_back(request.session);
  BoundSessions();
  return Verdict::kYes;
}

SessionOwners::Verdict SessionOwners::MayLeave(const JoinRequest& request,
                                               std::uint64_t participant) {
  const auto known = sessions_.find(request.session);
  const bool is_owner = known != sessions_.end() && known->second.participant == participant;
  const bool knows = request.secret != SessionId{} &&
                     auth::SessionOf(request.secret) == request.session;
  if (!is_owner && !knows) return Verdict::kOfAnother;
  Remove(request.session);
  return Verdict::kYes;
}

void SessionOwners::Accept(VehicleId vehicle, const SessionId& session) {
  vehicles_[vehicle] = session;
}

std::uint64_t SessionOwners::OwnerOf(VehicleId vehicle) const {
  const auto session = vehicles_.find(vehicle);
  if (session == vehicles_.end()) return 0;
  const auto owner = sessions_.find(session->second);
  return owner == sessions_.end() ? 0 : owner->second.participant;
}

void SessionOwners::Heard(VehicleId vehicle, SteadyTime now) {
  const auto session = vehicles_.find(vehicle);
  if (session == vehicles_.end()) return;
  const auto owner = sessions_.find(session->second);
  if (owner != sessions_.end()) owner->second.heard = now;
}

std::vector<VehicleId> SessionOwners::VehiclesOf(const SessionId& session) const {
  std::vector<VehicleId> vehicles;
  for (const auto& [vehicle, of] : vehicles_) {
    if (of == session) vehicles.push_back(vehicle);
  }
  return vehicles;
}

void SessionOwners::Forget(const std::function<bool(std::uint64_t)>& left) {
  const std::deque<SessionId> all = oldest_;
  for (const SessionId& session : all) {
    const auto known = sessions_.find(session);
    if (known != sessions_.end() && left(known->second.writer) && !HasPlace(session)) {
      Remove(session);
    }
  }
}

void SessionOwners::Remove(const SessionId& session) {
  const auto known = sessions_.find(session);
  if (known == sessions_.end()) return;
  const auto count = counts_.find(known->second.participant);
  if (--count->second == 0) counts_.erase(count);
  sessions_.erase(known);
  std::erase(oldest_, session);
}

void SessionOwners::BoundSessions() {
  if (sessions_.size() <= kMostSessions) return;
  const auto free = std::ranges::find_if(
      oldest_, [this](const SessionId& session) { return !HasPlace(session); });
  Remove(free == oldest_.end() ? oldest_.front() : SessionId(*free));
}

bool SessionOwners::HasPlace(const SessionId& session) const {
  return std::ranges::any_of(vehicles_, [&](const auto& of) { return of.second == session; });
}

}  // namespace giveway::link
