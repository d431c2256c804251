#include "services/link/inbox/signal_inbox.h"

#include <algorithm>

#include "services/link/convert/convert.h"
#include "services/link/inbox/participant_of.h"
#include "services/link/inbox/sample_check.h"

namespace giveway::link {

SignalInbox::SignalInbox(Reader<wire::SignalState> reader, ReaderEvents& events,
                         const WorldBinding& world, Nanoseconds least_period)
    : reader_(reader), events_(events), world_(world), gate_(least_period) {}

std::span<const SignalState> SignalInbox::Take(SteadyTime now) {
  CountMisses();  // before the samples: a miss is reported before the sample that ends it
  taken_.clear();
  reader_.TakeEach([&](const wire::SignalState& sample, const dds::SampleInfo& info) {
    Receive(sample, info.sample_identity.writer_guid(), now);
  });
  return taken_;
}

void SignalInbox::Receive(const wire::SignalState& sample, const rtps::GUID_t& writer,
                          SteadyTime now) {
  SignalState state;
  if (world_.Participant() != 0 && !world_.IsWorld(ParticipantOf(writer))) {
    ++strangers_;
  } else if (!FromWire(sample, state) || state.id == kNoSignal) {
    ++unreadable_;
  } else if (FaultOf(state) || !gate_.Passes(state.epoch, state.tick, now)) {
    ++implausible_;
  } else {
    Keep(state);
  }
}

void SignalInbox::Keep(const SignalState& state) {
  not_heard_.erase(Number(state.id));
  const auto at = std::lower_bound(
      taken_.begin(), taken_.end(), state,
      [](const SignalState& a, const SignalState& b) { return Number(a.id) < Number(b.id); });
  if (at != taken_.end() && at->id == state.id) {
    *at = state;
  } else if (taken_.size() < kMaxHeads) {
    taken_.insert(at, state);
  }
}

void SignalInbox::CountMisses() {
  for (const ReaderEvent& event : events_.Take().events) {
    if (not_heard_.size() == kMaxHeads) return;
    if (not_heard_.insert(KeyOf(event.handle)).second) ++deadline_missed_;
  }
}

}  // namespace giveway::link
