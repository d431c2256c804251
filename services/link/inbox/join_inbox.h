// The requests to join and to leave. A process is one session, so of a writer that speaks for many
// only the first few are passed on: one process alone cannot crowd the others out of the world's
// waiting list.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "services/link/fastdds/anchored_reader.h"
#include "services/link/fastdds/writer_names.h"
#include "services/types/fleet_facts.h"
#include "services/types/refusal.h"

namespace giveway::link {

class JoinInbox {
 public:
  explicit JoinInbox(Reader<wire::Join> reader) : reader_(reader) {}

  // The newest request of each session, those that leave first: a newcomer may want their ids.
  // `names` must be updated first. Appends the first few that were refused to `refusals`.
  std::vector<JoinRequest> Take(const WriterNames& names, std::vector<Refusal>& refusals);

  // Of sessions too many of one writer, or without a session.
  std::uint32_t Refused() const { return refused_; }

 private:
  bool MayAsk(std::uint64_t writer, const JoinRequest& request);
  void Refuse(const JoinRequest& request, std::uint64_t writer, std::vector<Refusal>& refusals);
  void ForgetDeparted(const WriterNames& names);

  AnchoredReader<wire::Join> reader_;
  std::unordered_map<std::uint64_t, std::vector<SessionId>> sessions_;  // by writer
  std::uint32_t refused_ = 0;
  std::uint32_t turns_ = 0;
};

}  // namespace giveway::link
