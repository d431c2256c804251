// What a participant's endpoints run with, read and changed while they run.
#include "services/link/participant.h"
#include "services/link/resolved_values.h"

namespace giveway::link {
namespace {

void Append(const std::string& profile, const std::vector<ResolvedValue>& values,
            std::vector<LiveValue>& live) {
  for (const ResolvedValue& value : values) live.push_back({profile, value.policy, value.number});
}

// Deadlines may change while an endpoint runs; discovery announces the change to its peers.
template <typename Entity, typename Qos>
bool Set(Entity& entity, Qos qos, const Duration& deadline) {
  qos.deadline().period = deadline;
  return Ok(entity.set_qos(qos));
}

}  // namespace

std::vector<LiveValue> Participant::LiveQos() const {
  std::vector<LiveValue> live;
  Append("giveway_participant", ValuesOf(participant_->get_qos()), live);
  for (const auto& [profile, writer] : writers_) {
    Append(profile, ValuesOf(writer->get_qos(), writer->get_publisher()->get_qos()), live);
  }
  for (const auto& [profile, reader] : readers_) {
    Append(profile, ValuesOf(reader->get_qos(), reader->get_subscriber()->get_qos()), live);
  }
  return live;
}

bool Participant::SetDeadline(const std::string& profile, const Duration& deadline) {
  bool all = true;
  for (const auto& [made_by, writer] : writers_) {
    if (made_by == profile) all = Set(*writer, writer->get_qos(), deadline) && all;
  }
  for (const auto& [made_by, reader] : readers_) {
    if (made_by == profile) all = Set(*reader, reader->get_qos(), deadline) && all;
  }
  return all;
}

}  // namespace giveway::link
