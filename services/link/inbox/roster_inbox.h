// What the world says about one session. Only one world is believed at a time, the first, until it
// has ended: world_binding.h. What another one says meanwhile is kept, and counts once it may be
// the world.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/link/fastdds/endpoint.h"
#include "services/link/fastdds/writer_names.h"
#include "services/link/inbox/world_binding.h"
#include "services/link/inbox/world_candidates.h"
#include "services/types/fleet_facts.h"
#include "services/types/refusal.h"

namespace giveway::link {

class RosterInbox {
 public:
  // Counts the entries of the session; a position to continue from.
  using Mark = std::uint64_t;

  // `world` outlives this.
  RosterInbox(Reader<wire::Roster> reader, WorldBinding& world) : reader_(reader), world_(world) {}

  void Follow(const SessionId& session) { session_ = session; }
  const SessionId& Session() const { return session_; }
  // From now on entries with another id are refused.
  void NameOwn(VehicleId own) { own_ = own; }

  // The newest entry after `mark`, which moves on; empty if none came. `names` must be updated
  // first.
  std::optional<RosterEntry> NewestAfter(Mark& mark, const WriterNames& names, SteadyTime now);
  // Whether the world's writer of the roster is there.
  bool WorldIsThere(const WriterNames& names) const;

  std::uint32_t Unreadable() const { return unreadable_; }
  std::uint32_t Implausible() const { return implausible_; }  // see entry_check.h
  std::uint32_t FromOtherWorlds() const { return from_other_worlds_; }
  // The first few since the last call.
  void TakeRefusals(std::vector<Refusal>* refusals);

 private:
  static constexpr std::size_t kMostRefusals = 4;

  void Receive(const wire::Roster& sample, const rtps::GUID_t& writer, const WriterNames& names,
               SteadyTime now);
  void CountOther(WorldCandidate& other);
  void Refuse(const RosterEntry& entry, std::uint64_t writer, const char* counter,
              const char* field, std::string why);
  void FollowWorlds(const WriterNames& names, SteadyTime now);
  void CountOthers();

  Reader<wire::Roster> reader_;
  WorldBinding& world_;
  SessionId session_{};
  VehicleId own_ = kNoVehicle;
  RosterEntry newest_;
  Mark entries_ = 0;
  WorldCandidates candidates_;
  std::vector<Refusal> refusals_;
  std::uint32_t unreadable_ = 0;
  std::uint32_t implausible_ = 0;
  std::uint32_t from_other_worlds_ = 0;
};

}  // namespace giveway::link
