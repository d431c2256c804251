#include "services/link/packet_filter/ask_pace.h"

#include <algorithm>
#include <chrono>

namespace giveway::link {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::size_t kNumberInAckNack = 8;  // the first one that it does not acknowledge
constexpr std::size_t kAckNackBytes = 24;    // without bits

// As long as the library takes to ask each writer once: its initialAcknackDelay.
constexpr Nanoseconds kTurn = milliseconds(70);
constexpr Nanoseconds kLongestInterval = seconds(1);
constexpr Nanoseconds kForgotten = seconds(10);  // not asked for so long: the library dropped it

// Whether an endpoint sent it; else it serves only to read what stands behind it.
bool IsOfAnEndpoint(SubmessageKind kind) {
  switch (kind) {
    case SubmessageKind::kPad:
    case SubmessageKind::kInfoTs:
    case SubmessageKind::kInfoSrc:
    case SubmessageKind::kInfoReplyIp4:
    case SubmessageKind::kInfoDst:
    case SubmessageKind::kInfoReply:
      return false;
    default:
      return kind < SubmessageKind::kVendorFirst;
  }
}

}  // namespace

std::optional<PrefixBytes> AskedParticipant(Bytes sent) {
  if (sent.size() < kRtpsHeaderBytes) return std::nullopt;
  std::optional<PrefixBytes> to;
  bool asks = false;
  SubmessageWalk walk(sent);
  Submessage part;
  while (walk.Next(&part)) {
    if (part.kind == SubmessageKind::kInfoDst) {
      PrefixBytes destination;
      if (to.has_value() || part.body.size() < destination.size()) return std::nullopt;
      std::copy_n(part.body.begin(), destination.size(), destination.begin());
      to = destination;
    } else if (part.kind == SubmessageKind::kAckNack) {
      if (part.body.size() != kAckNackBytes || part.SequenceNumber(kNumberInAckNack) != 0) {
        return std::nullopt;
      }
      asks = true;
    } else if (part.kind < SubmessageKind::kVendorFirst) {
      return std::nullopt;
    }
  }
  return asks && !walk.IsBroken() ? to : std::nullopt;
}

bool AskPace::MayAsk(const PrefixBytes& participant, SteadyTime now) {
  auto known = asked_.find(participant);
  if (known != asked_.end() && now - known->second.next >= kForgotten) {
    asked_.erase(known);
    known = asked_.end();
  }
  if (known == asked_.end()) {
    MakeRoom();
    asked_[participant] = {now, now + kTurn, now + kTurn};
    return true;
  }
  Turn& turn = known->second;
  if (now < turn.end) return true;
  if (now < turn.next) return false;
  turn.end = now + kTurn;
  turn.next = now + std::clamp((now - turn.first) / 4, kTurn, kLongestInterval);
  return true;
}

void AskPace::Hear(Bytes packet) {
  if (asked_.empty()) return;
  const auto known = asked_.find(SenderOf(packet));
  if (known == asked_.end()) return;
  SubmessageWalk walk(packet);
  Submessage part;
  while (walk.Next(&part)) {
    if (!IsOfAnEndpoint(part.kind) || IsAnnouncement(part)) continue;
    asked_.erase(known);
    return;
  }
}

void AskPace::MakeRoom() {
  if (asked_.size() < kMostAsked) return;
  asked_.erase(
      std::ranges::min_element(asked_, {}, [](const auto& asked) { return asked.second.first; }));
}

}  // namespace giveway::link
