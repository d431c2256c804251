#include "services/link/inbox/signal_inbox.h"

#include <algorithm>

#include "services/link/convert/convert.h"

namespace giveway::link {

SignalInbox::SignalInbox(Reader<wire::SignalState> reader, ReaderEvents& events)
    : reader_(reader), events_(events) {}

std::span<const SignalState> SignalInbox::Take() {
  CountMisses();  // before the samples: a miss is told before the sample that ends it
  taken_.clear();
  reader_.TakeEach([&](const wire::SignalState& sample, const dds::SampleInfo&) {
    SignalState state;
    if (FromWire(sample, state) && state.id != kNoSignal) {
      Keep(state);
    } else {
      ++unreadable_;
    }
  });
  return taken_;
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
