// What a participant's endpoints run with, read and changed while they run.
#include <algorithm>
#include <utility>

#include "services/link/admin_link.h"
#include "services/link/convert/convert.h"
#include "services/link/participant.h"
#include "services/link/resolved_values.h"
#include "services/types/check.h"

namespace giveway::link {
namespace {

// Of endpoints that are alike the first only: a world has a writer of the same profile for each
// vehicle, and an answer carries 60 000 bytes.
class LiveList {
 public:
  void Add(const std::string& profile, std::vector<ResolvedValue> values) {
    const auto like_it = std::pair(profile, std::move(values));
    if (std::ranges::find(listed_, like_it) == listed_.end()) listed_.push_back(like_it);
  }
  std::vector<LiveValue> Values() const {
    std::vector<LiveValue> live;
    for (const auto& [profile, values] : listed_) {
      for (const auto& value : values) live.push_back({profile, value.policy, value.number});
    }
    return live;
  }

 private:
  std::vector<std::pair<std::string, std::vector<ResolvedValue>>> listed_;
};

// Deadlines may change while an endpoint runs; discovery announces the change to its peers.
template <typename Entity, typename Qos>
bool Set(Entity& entity, Qos qos, const Duration& deadline) {
  qos.deadline().period = deadline;
  return Ok(entity.set_qos(qos));
}

}  // namespace

std::vector<LiveValue> Participant::LiveQos() const {
  LiveList live;
  live.Add("giveway_participant", ValuesOf(participant_->get_qos()));
  for (const auto& [profile, writer] : writers_) {
    live.Add(profile, ValuesOf(writer->get_qos(), writer->get_publisher()->get_qos()));
  }
  for (const auto& [profile, reader] : readers_) {
    live.Add(profile, ValuesOf(reader->get_qos(), reader->get_subscriber()->get_qos()));
  }
  return live.Values();
}

bool Participant::SetDeadline(const std::string& profile, const Duration& deadline) {
  bool all = true;
  for (const auto& [made_by, writer] : writers_) {
    if (made_by == profile) all = Set(*writer, writer->get_qos(), deadline) && all;
  }
  for (const auto& [made_by, reader] : readers_) {
    if (made_by == profile) all = Set(*reader, reader->get_qos(), deadline) && all;
  }
  if (all) deadlines_[profile] = deadline;
  return all;
}

Duration Participant::DeadlineOf(const std::string& profile, const Duration& loaded) const {
  const auto changed = deadlines_.find(profile);
  return changed == deadlines_.end() ? loaded : changed->second;
}

AdminAnswer AsReceived(const AdminAnswer& answer) {
  AdminAnswer received;
  GIVEWAY_CHECK(FromWire(ToWire(answer), received), "an answer's live values are not its own");
  return received;
}

}  // namespace giveway::link
