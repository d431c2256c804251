#include "services/link/inbox/roster_inbox.h"

#include <algorithm>
#include <utility>

#include "services/link/convert/convert.h"
#include "services/link/inbox/entry_check.h"
#include "services/link/inbox/participant_of.h"

namespace giveway::link {

std::optional<RosterEntry> RosterInbox::NewestAfter(Mark& mark, const WriterNames& names,
                                                    SteadyTime now) {
  reader_.TakeEach([&](const wire::Roster& sample, const dds::SampleInfo& info) {
    if (sample.session() != session_) return;
    Receive(sample, info.sample_identity.writer_guid(), now);
  });
  FollowWorlds(names, now);
  CountOthers();
  if (std::exchange(mark, entries_) == entries_) return std::nullopt;
  return newest_;
}

void RosterInbox::Receive(const wire::Roster& sample, const rtps::GUID_t& writer, SteadyTime now) {
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
    Keep({ParticipantOf(writer), Identity(writer), std::move(entry)});
    return;
  }
  newest_ = std::move(entry);
  ++entries_;
  world_.Heard(now);
}

// The newest of each; of too many the first to come goes.
void RosterInbox::Keep(Candidate candidate) {
  const auto same = std::ranges::find(candidates_, candidate.participant, &Candidate::participant);
  if (same != candidates_.end()) candidates_.erase(same);
  if (candidates_.size() == kMostCandidates) candidates_.erase(candidates_.begin());
  candidates_.push_back(std::move(candidate));
}

void RosterInbox::CountOthers() {
  for (Candidate& other : candidates_) {
    if (!std::exchange(other.is_new, false)) continue;
    ++from_other_worlds_;
    Refuse(other.entry, other.writer, "old_world_entries", "writer",
           "another world is there and is the one that is believed, until it ends");
  }
}

// Of several that may be the world the one found last: a world that was started again.
void RosterInbox::FollowWorlds(const WriterNames& names, SteadyTime now) {
  if (candidates_.empty() || !world_.MayBeFollowed(now, !WorldIsThere(names))) return;
  const Candidate* best = nullptr;
  std::uint64_t best_found = 0;
  for (const Candidate& candidate : candidates_) {
    const WriterEntry* const writer = names.Find(candidate.writer);
    if (writer == nullptr || writer->gone || writer->found <= best_found) continue;
    best = &candidate;
    best_found = writer->found;
  }
  if (best == nullptr) return;
  world_.Bind(best->participant, best->writer, now);
  newest_ = best->entry;
  ++entries_;
  const std::uint64_t bound = best->participant;
  std::erase_if(candidates_, [bound](const Candidate& one) { return one.participant == bound; });
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
