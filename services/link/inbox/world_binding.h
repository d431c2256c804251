// Which participant is the world: the first that gave this vehicle a place, for as long as it
// lives. Another one that speaks as the world meanwhile is not believed. It has ended when its
// writer of the roster has left, or when it has been silent for longer than a world that lives can
// be. Knows no DDS, has no clock.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

#include "services/link/inbox/silence_limit.h"
#include "services/types/time.h"

namespace giveway::link {

class WorldBinding {
 public:
  // Of a vehicle that it sends scans to, every tick (never less than a few ticks); and of one that
  // still waits for a place, to which it has nothing to say.
  static constexpr Nanoseconds kSilence = std::chrono::seconds(1);
  static constexpr Nanoseconds kSilenceToAWaiting = std::chrono::seconds(5);

  explicit WorldBinding(Nanoseconds tick_period = Nanoseconds{0})
      : silence_(SilenceLimit(kSilence, tick_period)) {}

  // 0: none yet. The filters of the library's threads read it.
  const std::atomic<std::uint64_t>& Participant() const { return participant_; }
  bool IsWorld(std::uint64_t participant) const { return participant_ == participant; }
  std::uint64_t RosterWriter() const { return roster_writer_; }

  // Something that the world said was believed.
  void Heard(SteadyTime now) { heard_ = now; }
  // The vehicle has a place from now on: it is sent scans.
  void ExpectScans(SteadyTime now) {
    expects_scans_ = true;
    heard_ = now;
  }
  // Whether another one may be the world. `left`: the world's writer of the roster has.
  bool MayBeFollowed(SteadyTime now, bool left) const {
    const Nanoseconds patience = expects_scans_ ? silence_ : kSilenceToAWaiting;
    return participant_ == 0 || left || now - heard_ > patience;
  }
  void Bind(std::uint64_t participant, std::uint64_t roster_writer, SteadyTime now) {
    participant_ = participant;
    roster_writer_ = roster_writer;
    heard_ = now;
  }

 private:
  const Nanoseconds silence_;
  std::atomic<std::uint64_t> participant_{0};
  std::uint64_t roster_writer_ = 0;
  SteadyTime heard_{0};
  bool expects_scans_ = false;
};

}  // namespace giveway::link
