// What the signal heads said, the newest of each. One reader hears every head, and the library does
// not say by polling which one missed its deadline; hence the events.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

#include "services/link/fastdds/endpoint.h"
#include "services/link/fastdds/reader_events.h"
#include "services/link/inbox/tick_gate.h"
#include "services/link/inbox/world_binding.h"
#include "services/types/signal.h"

namespace giveway::link {

class SignalInbox {
 public:
  static constexpr std::size_t kMaxHeads = 1024;  // of a scenario; further ones are ignored

  // The deadline misses of `reader` go to `events`; `world` outlives this. `least_period`: from one
  // tick of a world to the next.
  SignalInbox(Reader<wire::SignalState> reader, ReaderEvents& events, const WorldBinding& world,
              Nanoseconds least_period);

  // The newest of each head since the last call, by id. Holds until the next call. `now` is of the
  // clock that worlds are watched by.
  std::span<const SignalState> Take(SteadyTime now);

  std::uint32_t Unreadable() const { return unreadable_; }    // see FromWire, or without an id
  std::uint32_t Strangers() const { return strangers_; }      // not of the world
  std::uint32_t Implausible() const { return implausible_; }  // see sample_check.h, tick_gate.h
  // Edges: once a head until it is heard again.
  std::uint32_t DeadlineMissed() const { return deadline_missed_; }

 private:
  void Receive(const wire::SignalState& sample, const rtps::GUID_t& writer, SteadyTime now);
  void Keep(const SignalState& state);
  void CountMisses();

  Reader<wire::SignalState> reader_;
  ReaderEvents& events_;
  const WorldBinding& world_;
  TickGate gate_;
  std::vector<SignalState> taken_;               // by id
  std::unordered_set<std::uint32_t> not_heard_;  // heads that missed their deadline
  std::uint32_t unreadable_ = 0;
  std::uint32_t strangers_ = 0;
  std::uint32_t implausible_ = 0;
  std::uint32_t deadline_missed_ = 0;
};

}  // namespace giveway::link
