#include "services/link/inbox/session_owners.h"

#include "services/auth/digest.h"

namespace giveway::link {

SessionOwners::Verdict SessionOwners::MayAsk(const JoinRequest& request, std::uint64_t participant,
                                             std::uint64_t writer, SteadyTime now,
                                             const std::function<bool(std::uint64_t)>& left) {
  const auto known = sessions_.find(request.session);
  const bool is_known = known != sessions_.end();
  if (is_known && known->second.participant != participant) {
    const Owner& owner = known->second;
    const Nanoseconds patience =
        owner.commands ? silence_ : std::max(silence_, kSilenceBeforeCommands);
    if (!left(owner.writer) && now - owner.heard <= patience) return Verdict::kOfAnother;
  }
  const bool counts = is_known && !known->second.over && known->second.participant == participant;
  const auto count = counts_.find(participant);
  if (!counts && count != counts_.end() && count->second >= kMostOfOne) return Verdict::kTooMany;
  if (is_known) Count(known->second, -1);
  const Owner owner{.participant = participant,
                    .writer = writer,
                    .heard = now,
                    .age = is_known ? known->second.age : ++last_age_};
  Count(owner, 1);
  sessions_.insert_or_assign(request.session, owner);
  if (is_known) return Verdict::kYes;
  List(request.session);
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
  const auto known = vehicles_.find(vehicle);
  if (known != vehicles_.end() && known->second == session) return;
  Close(vehicle);
  Unlist(session);
  vehicles_.emplace(vehicle, session);
  places_[session].push_back(vehicle);
  List(session);
}

void SessionOwners::Close(VehicleId vehicle) {
  const auto known = vehicles_.find(vehicle);
  if (known == vehicles_.end()) return;
  const SessionId session = known->second;
  vehicles_.erase(known);
  Unlist(session);
  const auto places = places_.find(session);
  std::erase(places->second, vehicle);
  if (places->second.empty()) places_.erase(places);
  List(session);
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
  if (owner == sessions_.end()) return;
  owner->second.heard = now;
  owner->second.commands = true;
}

const std::vector<VehicleId>& SessionOwners::VehiclesOf(const SessionId& session) const {
  static const std::vector<VehicleId> none;
  const auto places = places_.find(session);
  return places == places_.end() ? none : places->second;
}

void SessionOwners::Forget(const std::function<bool(std::uint64_t)>& left) {
  for (auto next = to_go_.begin(); next != to_go_.end() && !next->first.first;) {
    const auto known = sessions_.find((next++)->second);
    if (left(known->second.writer)) Remove(known);
  }
}

void SessionOwners::Count(const Owner& owner, int change) {
  if (owner.over) return;
  const auto count = counts_.try_emplace(owner.participant, 0).first;
  count->second = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(count->second) + change);
  if (count->second == 0) counts_.erase(count);
}

void SessionOwners::Remove(Known::iterator known) {
  Unlist(known->first);
  Count(known->second, -1);
  sessions_.erase(known);
}

void SessionOwners::BoundSessions() {
  if (sessions_.size() <= kMostSessions) return;
  Remove(sessions_.find(to_go_.begin()->second));
}

void SessionOwners::Unlist(const SessionId& session) {
  const auto known = sessions_.find(session);
  if (known != sessions_.end()) to_go_.erase({HasPlace(session), known->second.age});
}

void SessionOwners::List(const SessionId& session) {
  const auto known = sessions_.find(session);
  if (known == sessions_.end()) return;
  to_go_.emplace(std::pair{HasPlace(session), known->second.age}, session);
}

}  // namespace giveway::link
