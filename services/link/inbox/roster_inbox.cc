#include "services/link/inbox/roster_inbox.h"

#include <utility>

#include "services/link/convert/convert.h"
#include "services/link/inbox/entry_check.h"
#include "services/link/inbox/participant_of.h"

namespace giveway::link {
namespace {

WorldCandidates::Found FoundIn(const WriterNames& names) {
  return [&names](std::uint64_t identity) -> std::uint64_t {
    const WriterEntry* const writer = names.Find(identity);
    return writer == nullptr || writer->gone ? 0 : writer->found;
  };
}

}  // namespace

std::optional<RosterEntry> RosterInbox::NewestAfter(Mark& mark, const WriterNames& names,
                                                    SteadyTime now) {
  reader_.TakeEach([&](const wire::Roster& sample, const dds::SampleInfo& info) {
    if (sample.session() != session_) return;
    Receive(sample, info.sample_identity.writer_guid(), names, now);
  });
  FollowWorlds(names, now);
  CountOthers();
  if (std::exchange(mark, entries_) == entries_) return std::nullopt;
  return newest_;
}

void RosterInbox::Receive(const wire::Roster& sample, const rtps::GUID_t& writer,
                          const WriterNames& names, SteadyTime now) {
  RosterEntry entry;
  if (!FromWire(sample, entry)) {
    ++unreadable_;
    return;
  }
  if (const auto fault = FaultOf(entry, own_)) {
    ++implausible_;
    Refuse(entry, Identity(writer), "implausible", fault->field, Describe(*fault));
    return;
  }
  if (!world_.IsWorld(ParticipantOf(writer))) {
    auto gone = candidates_.Keep({ParticipantOf(writer), Identity(writer), std::move(entry)},
                                 FoundIn(names));
    for (WorldCandidate& other : gone) {
      if (other.participant != ParticipantOf(writer)) CountOther(other);
    }
    return;
  }
  newest_ = std::move(entry);
  ++entries_;
  world_.Heard(now);
}

void RosterInbox::CountOthers() {
  for (WorldCandidate& other : candidates_.All()) CountOther(other);
}

void RosterInbox::CountOther(WorldCandidate& other) {
  if (!std::exchange(other.is_new, false)) return;
  ++from_other_worlds_;
  Refuse(other.entry, other.writer, "old_world_entries", "writer",
         "another world is there and is the one that is believed, until it ends");
}

void RosterInbox::FollowWorlds(const WriterNames& names, SteadyTime now) {
  if (candidates_.All().empty() || !world_.MayBeFollowed(now, !WorldIsThere(names))) return;
  const WorldCandidate* const best = candidates_.Best(FoundIn(names));
  if (best == nullptr) return;
  world_.Bind(best->participant, best->writer, now);
  newest_ = best->entry;
  ++entries_;
  candidates_.Remove(best->participant);
}

bool RosterInbox::WorldIsThere(const WriterNames& names) const {
  const WriterEntry* const writer = names.Find(world_.RosterWriter());
  return writer != nullptr && !writer->gone;
}

void RosterInbox::Refuse(const RosterEntry& entry, std::uint64_t writer, const char* counter,
                         const char* field, std::string why) {
  if (refusals_.size() == kMostRefusals) return;
  refusals_.push_back({.sample = "roster entry",
                       .vehicle = entry.vehicle,
                       .writer = writer,
                       .counter = counter,
                       .field = field,
                       .why = std::move(why)});
}

void RosterInbox::TakeRefusals(std::vector<Refusal>* refusals) {
  for (Refusal& refusal : refusals_) refusals->push_back(std::move(refusal));
  refusals_.clear();
}

}  // namespace giveway::link
