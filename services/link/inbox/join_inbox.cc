#include "services/link/inbox/join_inbox.h"

#include <algorithm>
#include <string>

#include "services/link/convert/convert.h"

namespace giveway::link {
namespace {

constexpr std::size_t kSessionsOfOne = 8;     // a process has one, or a test a few
constexpr std::uint32_t kForgetEvery = 32;    // turns
constexpr std::size_t kMostRefusedJoins = 8;  // kept for the log; the counter has all

}  // namespace

std::vector<JoinRequest> JoinInbox::Take(const WriterNames& names, std::vector<Refusal>& refusals) {
  if (++turns_ % kForgetEvery == 0) ForgetDeparted(names);
  std::vector<JoinRequest> joins;
  reader_.TakeEach([&](const wire::Join& sample, const dds::SampleInfo& info) {
    JoinRequest request;
    FromWire(sample, request);
    const std::uint64_t writer = Identity(info.sample_identity.writer_guid());
    if (request.session != SessionId{} && MayAsk(writer, request)) {
      joins.push_back(request);
    } else {
      Refuse(request, writer, refusals);
    }
  });
  std::stable_partition(joins.begin(), joins.end(),
                        [](const JoinRequest& request) { return request.leaving; });
  return joins;
}

void JoinInbox::Refuse(const JoinRequest& request, std::uint64_t writer,
                       std::vector<Refusal>& refusals) {
  ++refused_;
  if (refusals.size() >= kMostRefusedJoins) return;
  Refusal& refusal = refusals.emplace_back();
  refusal.sample = "join";
  refusal.vehicle = request.wanted;
  refusal.writer = writer;
  refusal.counter = "joins_refused";
  refusal.field = "session";
  refusal.why = request.session == SessionId{}
                    ? "session is 0, must be 128 random bits"
                    : "session is the " + std::to_string(kSessionsOfOne + 1) +
                          "th of one writer, must be one for each life of a process";
}

bool JoinInbox::MayAsk(std::uint64_t writer, const JoinRequest& request) {
  std::vector<SessionId>& sessions = sessions_[writer];
  // A session may leave by another writer than it came by: its process, or the world, was
  // restarted.
  if (request.leaving) {
    std::erase(sessions, request.session);
    return true;
  }
  const bool known = std::ranges::find(sessions, request.session) != sessions.end();
  if (!known && sessions.size() == kSessionsOfOne) return false;
  if (!known) sessions.push_back(request.session);
  return true;
}

// The reader asks for no deadline: no timer waits for an instance.
void JoinInbox::ForgetDeparted(const WriterNames& names) {
  RemoveDeparted<wire::Join>(reader_.Entity(), dds::HANDLE_NIL);
  std::erase_if(sessions_, [&](const auto& of_writer) {
    const WriterEntry* const writer = names.Find(of_writer.first);
    return writer == nullptr || writer->gone;
  });
}

}  // namespace giveway::link
