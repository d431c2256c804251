// What the world says about one session. Only one world speaks at a time: when another one has
// taken over, what the old one said late or says again is not told.
#pragma once

#include <cstdint>
#include <optional>

#include "services/link/fastdds/endpoint.h"
#include "services/link/fastdds/writer_names.h"
#include "services/types/fleet_facts.h"

namespace giveway::link {

class RosterInbox {
 public:
  // Counts the entries of the session; a place to go on from.
  using Mark = std::uint64_t;

  explicit RosterInbox(Reader<wire::Roster> reader) : reader_(reader) {}

  void Follow(const SessionId& session) { session_ = session; }
  const SessionId& Session() const { return session_; }

  // The newest entry after `mark`, which moves on; empty if none came. `names` must be updated
  // first.
  std::optional<RosterEntry> NewestAfter(Mark& mark, const WriterNames& names);

  std::uint32_t Unreadable() const { return unreadable_; }
  std::uint32_t FromOldWorlds() const { return from_old_worlds_; }

 private:
  bool Speaks(const WriterEntry& writer, const WriterNames& names);

  Reader<wire::Roster> reader_;
  SessionId session_{};
  RosterEntry newest_;
  Mark entries_ = 0;
  std::uint64_t world_ = 0;  // identity of the writer that speaks; 0 before the first entry
  std::uint32_t unreadable_ = 0;
  std::uint32_t from_old_worlds_ = 0;
};

}  // namespace giveway::link
