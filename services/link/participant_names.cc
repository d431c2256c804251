#include "services/link/participant_names.h"

#include <algorithm>

#include "services/link/fastdds/topics.h"
#include "services/link/inbox/participant_of.h"

namespace giveway::link {

void ParticipantNames::OnWriter(Change change, const rtps::GUID_t& writer,
                                const std::vector<std::string>& partitions) {
  {
    const std::scoped_lock lock(mutex_);
    const bool of_world = partitions.size() == 1 && partitions.front() == kWorldPartition;
    if (change == Change::kGone) {
      speakers_.erase(Identity(writer));
    } else if ((of_world || !BeaconArea(partitions).empty()) && speakers_.size() < kMostWriters) {
      speakers_.try_emplace(Identity(writer),
                            Speaker{of_world ? kNoVehicle : NamedVehicle(partitions),
                                    ParticipantOf(writer), ++found_});
    }
  }
  writers_.OnWriter(change, writer, partitions);
}

std::uint64_t ParticipantNames::FirstOf(VehicleId vehicle) const {
  const Speaker* first = nullptr;
  for (const auto& [writer, speaker] : speakers_) {
    if (speaker.vehicle != vehicle) continue;
    if (first == nullptr || speaker.found < first->found) first = &speaker;
  }
  return first == nullptr ? 0 : first->participant;
}

bool ParticipantNames::Owns(VehicleId vehicle, const rtps::GUID_t& endpoint) const {
  const std::scoped_lock lock(mutex_);
  return FirstOf(vehicle) == ParticipantOf(endpoint);
}

std::uint64_t ParticipantNames::World() const {
  const std::scoped_lock lock(mutex_);
  return FirstOf(kNoVehicle);
}

bool ParticipantNames::IsWorld(std::uint64_t participant) const {
  const std::scoped_lock lock(mutex_);
  return std::ranges::any_of(speakers_, [participant](const auto& speaker) {
    return speaker.second.vehicle == kNoVehicle && speaker.second.participant == participant;
  });
}

}  // namespace giveway::link
