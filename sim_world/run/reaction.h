// Measures reaction times: from the publication of the scans of the tick that first showed a cause
// to the application of the first command that reacts to it. Reads no clock; times are arguments.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "services/types/motor_command.h"
#include "services/types/time.h"

namespace giveway::sim {

struct ReactionFigures {
  std::uint32_t count = 0;
  // By nearest rank over the newest kept samples; max over all. None without a sample.
  std::optional<double> p50_ms;
  std::optional<double> p99_ms;
  std::optional<double> max_ms;
};

class ReactionMeter {
 public:
  static constexpr std::size_t kRememberedTicks = 64;
  // 64 KiB, a part of the object: a run of many hours takes no more memory than one of a minute.
  static constexpr std::size_t kKeptSamples = 8192;

  // The scans of `tick` were published at `at`. Called for ticks of the run only, so that nothing
  // before the start signal counts as a cause.
  void Published(Tick tick, SteadyTime at);
  // The world applied the command at `at`. Counts it if it is the first of a new decision whose
  // cause is a published tick that is still kept.
  void Applied(const MotorCommand& command, SteadyTime at);

  ReactionFigures Figures() const;
  std::uint32_t Count() const { return count_; }

 private:
  struct Publication {
    Tick tick = kNoTick;
    SteadyTime at{0};
  };

  std::array<Publication, kRememberedTicks> publications_{};  // [tick % kRememberedTicks]
  std::array<Nanoseconds, kKeptSamples> samples_{};           // [count % kKeptSamples]
  std::uint32_t count_ = 0;
  Nanoseconds longest_{0};
};

}  // namespace giveway::sim
