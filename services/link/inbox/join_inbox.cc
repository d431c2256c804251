#include "services/link/inbox/join_inbox.h"

#include <algorithm>
#include <string>

#include "services/link/convert/convert.h"
#include "services/link/inbox/participant_of.h"

namespace giveway::link {
namespace {

constexpr std::uint32_t kForgetEvery = 32;    // turns
constexpr std::size_t kMostRefusedJoins = 8;  // kept for the log; the counter has all

bool HasLeft(const WriterNames& names, std::uint64_t writer) {
  const WriterEntry* const entry = names.Find(writer);
  return entry == nullptr || entry->gone;
}

Refusal RefusalOf(const JoinRequest& request, std::uint64_t writer, const char* why) {
  Refusal refusal;
  refusal.sample = request.leaving ? "leave" : "join";
  refusal.vehicle = request.wanted;
  refusal.writer = writer;
  refusal.counter = "joins_refused";
  refusal.field = "session";
  refusal.why = why;
  return refusal;
}

}  // namespace

std::vector<JoinRequest> JoinInbox::Take(const WriterNames& names, SteadyTime now,
                                         std::vector<Refusal>& refusals) {
  std::vector<JoinRequest> joins;
  reader_.TakeEach([&](const wire::Join& sample, const dds::SampleInfo& info) {
    const rtps::GUID_t& writer = info.sample_identity.writer_guid();
    JoinRequest request;
    FromWire(sample, request);
    const char* const why = WhyNot(request, writer, names, now);
    if (why == nullptr) return joins.push_back(request);
    ++refused_;
    if (refusals.size() < kMostRefusedJoins) {
      refusals.push_back(RefusalOf(request, Identity(writer), why));
    }
  });
  // After the last requests of departed participants were read.
  if (++turns_ % kForgetEvery == 0) ForgetDeparted(names);
  std::stable_partition(joins.begin(), joins.end(),
                        [](const JoinRequest& request) { return request.leaving; });
  return joins;
}

const char* JoinInbox::WhyNot(const JoinRequest& request, const rtps::GUID_t& writer,
                              const WriterNames& names, SteadyTime now) {
  if (request.session == SessionId{}) return "session is 0, must be 128 random bits";
  const std::uint64_t participant = ParticipantOf(writer);
  const auto left = [&names](std::uint64_t identity) { return HasLeft(names, identity); };
  const auto verdict = request.leaving
                           ? owners_.MayLeave(request, participant)
                           : owners_.MayAsk(request, participant, Identity(writer), now, left);
  switch (verdict) {
    case SessionOwners::Verdict::kYes:
      return nullptr;
    case SessionOwners::Verdict::kTooMany:
      return "session is one more of a participant that has many, must be one for each life of a "
             "process";
    case SessionOwners::Verdict::kOfAnother:
      return "session is another participant's, which is there";
  }
  return nullptr;
}

// The reader asks for no deadline: no timer waits for an instance.
void JoinInbox::ForgetDeparted(const WriterNames& names) {
  RemoveDeparted<wire::Join>(reader_.Entity(), dds::HANDLE_NIL);
  owners_.Forget([&names](std::uint64_t writer) { return HasLeft(names, writer); });
}

}  // namespace giveway::link
