#include "services/link/inbox/roster_inbox.h"

#include <utility>

#include "services/link/convert/convert.h"

namespace giveway::link {

std::optional<RosterEntry> RosterInbox::NewestAfter(Mark& mark, const WriterNames& names) {
  reader_.TakeEach([&](const wire::Roster& sample, const dds::SampleInfo& info) {
    if (sample.session() != session_) return;
    const WriterEntry* const writer = names.Find(info.sample_identity.writer_guid());
    RosterEntry entry;
    if (!FromWire(sample, entry)) {
      ++unreadable_;
    } else if (writer == nullptr || !Speaks(*writer, names)) {
      ++from_old_worlds_;
    } else {
      newest_ = std::move(entry);
      ++entries_;
    }
  });
  if (std::exchange(mark, entries_) == entries_) return std::nullopt;
  return newest_;
}

// The world found last speaks. Once it is gone the one before may speak again: it was then not old,
// only discovered earlier.
bool RosterInbox::Speaks(const WriterEntry& writer, const WriterNames& names) {
  const WriterEntry* const speaker = names.Find(world_);
  if (speaker != nullptr && !speaker->gone && writer.found < speaker->found) return false;
  world_ = writer.identity;
  return true;
}

}  // namespace giveway::link
