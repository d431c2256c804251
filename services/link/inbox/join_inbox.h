// The requests to join and to leave. A process is one session, so of a participant that speaks for
// many only the first few are passed on: one process alone cannot crowd the others out of the
// world's waiting list. Nor can it leave for others, or take their sessions: session_owners.h.
#pragma once

#include <cstdint>
#include <vector>

#include "services/link/fastdds/anchored_reader.h"
#include "services/link/fastdds/writer_names.h"
#include "services/link/inbox/session_owners.h"
#include "services/types/fleet_facts.h"
#include "services/types/refusal.h"

namespace giveway::link {

class JoinInbox {
 public:
  // `tick_period`: of the world that this is for.
  JoinInbox(Reader<wire::Join> reader, Nanoseconds tick_period)
      : reader_(reader), owners_(tick_period) {}

  // The newest request of each session, those that leave first: a newcomer may want their ids.
  // `names` must be updated first. Appends the first few that were refused to `refusals`.
  std::vector<JoinRequest> Take(const WriterNames& names, SteadyTime now,
                                std::vector<Refusal>& refusals);

  // Of sessions too many of one participant, of another's session, or without one.
  std::uint32_t Refused() const { return refused_; }
  SessionOwners& Owners() { return owners_; }

 private:
  const char* WhyNot(const JoinRequest& request, const rtps::GUID_t& writer,
                     const WriterNames& names, SteadyTime now);
  void ForgetDeparted(const WriterNames& names);

  AnchoredReader<wire::Join> reader_;
  SessionOwners owners_;
  std::uint32_t refused_ = 0;
  std::uint32_t turns_ = 0;
};

}  // namespace giveway::link
