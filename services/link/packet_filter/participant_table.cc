#include "services/link/packet_filter/participant_table.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace giveway::link {
namespace {

// In addition to two a vehicle. Beyond, a stranger is forgotten, and has to take its turn again.
constexpr std::size_t kMostParticipants = 1024;
// One that announced itself as often is no stranger, unless the library has dropped it since.
constexpr std::uint32_t kKnown = 16;

struct EndpointParts {
  PrefixBytes prefix;
  std::uint32_t entity;
};

EndpointParts PartsOf(const EndpointGuid& endpoint) {
  EndpointParts parts;
  std::copy_n(endpoint.begin(), parts.prefix.size(), parts.prefix.begin());
  std::memcpy(&parts.entity, endpoint.data() + parts.prefix.size(), sizeof parts.entity);
  return parts;
}

}  // namespace

ParticipantTable::ParticipantTable(std::uint32_t strangers, std::uint32_t fleet_size)
    : most_participants_(kMostParticipants + 2 * std::size_t{fleet_size}),
      new_participants_(strangers + 2 * std::int64_t{fleet_size}, kStrangersPerSecond),
      common_endpoints_(
          strangers * kCommonEndpointsAStranger + fleet_size * kCommonEndpointsAVehicle,
          kEndpointsPerSecond) {}

bool ParticipantTable::MayJoin(const PrefixBytes& participant, SteadyTime now) {
  auto known = participants_.find(participant);
  if (known == participants_.end()) {
    if (!new_participants_.Take(now)) return false;
    MakeRoom(now);
    known = participants_.try_emplace(participant).first;
  }
  known->second.heard = now;
  if (known->second.announcements < kKnown) ++known->second.announcements;
  return true;
}

bool ParticipantTable::MayAdd(const EndpointGuid& endpoint, SteadyTime now) {
  const auto [prefix, entity] = PartsOf(endpoint);
  const auto known = participants_.find(prefix);
  if (known == participants_.end()) return common_endpoints_.Take(now);
  std::set<std::uint32_t>& endpoints = known->second.endpoints;
  if (endpoints.contains(entity)) return true;
  if (endpoints.size() >= kOwnEndpoints && !common_endpoints_.Take(now)) return false;
  if (endpoints.size() == kMostEndpointsKept) endpoints.clear();
  endpoints.insert(entity);
  return true;
}

void ParticipantTable::Remove(const EndpointGuid& endpoint) {
  const auto [prefix, entity] = PartsOf(endpoint);
  const auto known = participants_.find(prefix);
  if (known == participants_.end() || known->second.endpoints.erase(entity) == 0) return;
  if (known->second.endpoints.size() >= kOwnEndpoints) common_endpoints_.GiveBack();
}

ArrivalWindow* ParticipantTable::WindowOf(const PrefixBytes& participant, std::size_t writer) {
  const auto known = participants_.find(participant);
  return known == participants_.end() ? nullptr : &known->second.windows[writer];
}

void ParticipantTable::End(const PrefixBytes& participant) {
  const auto known = participants_.find(participant);
  if (known == participants_.end()) return;
  known->second.announcements = 0;
  known->second.windows = {};
}

// In the place of the stranger silent longest; without strangers, of the participant.
void ParticipantTable::MakeRoom(SteadyTime now) {
  if (participants_.size() < most_participants_) return;
  participants_.erase(std::ranges::min_element(participants_, {}, [now](const auto& participant) {
    const auto& [announcements, heard, endpoints, windows] = participant.second;
    return std::pair(announcements >= kKnown && now - heard < kLongestLease, heard);
  }));
}

}  // namespace giveway::link
