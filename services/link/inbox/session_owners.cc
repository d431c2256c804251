#include "services/link/inbox/session_owners.h"

#include <algorithm>

#include "services/auth/digest.h"

namespace giveway::link {

SessionOwners::Verdict SessionOwners::MayAsk(const JoinRequest& request, std::uint64_t participant,
                                             std::uint64_t writer, SteadyTime now,
                                             const std::function<bool(std::uint64_t)>& left) {
  const auto known = sessions_.find(request.session);
  if (known != sessions_.end() && known->second.participant != participant) {
    const Nanoseconds patience = HasPlace(request.session) ? kSilence : kSilenceOfAWaiting;
    const Owner& owner = known->second;
    if (!left(owner.writer) && now - owner.heard <= patience) return Verdict::kOfAnother;
  }
  const bool counts =
      known != sessions_.end() && !known->second.over && known->second.participant == participant;
  const auto count = counts_.find(participant);
  if (!counts && count != counts_.end() && count->second >= kMostOfOne) return Verdict::kTooMany;
  if (known != sessions_.end()) {
    Count(known->second, -1);
  } else {
    oldest_.push_back(request.session);
  }
  const Owner owner{participant, writer, now};
  Count(owner, 1);
  sessions_.insert_or_assign(request.session, owner);
  BoundSessions();
  return Verdict::kYes;
}

SessionOwners::Verdict SessionOwners::MayLeave(const JoinRequest& request,
                                               std::uint64_t participant) {
  const auto known = sessions_.find(request.session);
  const bool is_owner = known != sessions_.end() && known->second.participant == participant;
  const bool knows =
      request.secret != SessionId{} && auth::SessionOf(request.secret) == request.session;
  if (!is_owner && !knows) return Verdict::kOfAnother;
  if (known != sessions_.end()) {
    Count(known->second, -1);
    known->second.over = true;
  }
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

void SessionOwners::Count(const Owner& owner, int change) {
  if (owner.over) return;
  const auto count = counts_.try_emplace(owner.participant, 0).first;
  count->second = static_cast<std::size_t>(static_cast<int>(count->second) + change);
  if (count->second == 0) counts_.erase(count);
}

void SessionOwners::Remove(const SessionId& session) {
  const auto known = sessions_.find(session);
  if (known == sessions_.end()) return;
  Count(known->second, -1);
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
