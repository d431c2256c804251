// How far the numbers of one writer can have come by now: sequence numbers, or the counts of its
// HEARTBEATs. A budget that time fills and each number above the highest one draws on, so that
// forged packets, however many, move a writer's numbers no faster than time allows.
//
// The budget holds the slack at most. It fills at twice the writer's pace, and at least at
// kLeastRate_hz; while nothing is heard from the writer it grows beyond the slack at the same rate,
// so that numbers pass after a loss, however long. The pace is learnt from numbers that passed.
//
// Lower numbers are always plausible: a restarted writer of some vendors keeps its GUID. Of a
// writer that sends samples and GAPs again they say nothing of where it is. Any other sends no
// number twice: it is heard, so it has lost nothing; and once its numbers lie behind the highest by
// more than the slack, two senders may be at it. For kDisputeTime the budget fills at little more
// than the pace then, and nothing is learnt, so that a forger cannot run far ahead of the true
// writer, whose readers skip what lies behind.
//
// A writer whose numbers really did jump is believed once it has kept to its new numbers for
// kConfirmTime and said nothing by the former ones. Numbers of which only some reach this process
// may step far meanwhile, and the budget fills by how fast they did from then on.
#pragma once

#include <cstdint>

#include "services/types/time.h"

namespace giveway::link {

class SequenceBudget {
 public:
  struct Limits {
    double least = 64;         // slack, numbers; the larger of it and the next
    double seconds = 0.5;      // of the writer's pace
    bool sends_again = false;  // lower numbers, as a matter of course
    bool may_grow = false;     // steps of one are free at any rate, as while a writer is young
    bool are_shared = false;   // most of its numbers go to others: the slack is there at once

    double SlackAt(double pace_hz) const {
      return pace_hz * seconds > least ? pace_hz * seconds : least;
    }
  };

  static constexpr double kLeastRate_hz = 256;
  static constexpr double kHighestRate_hz = 16384;
  static constexpr double kYoungSlack = 64;
  // A writer heard for less time has no known pace: its steps of one are free and draw on nothing,
  // kYoungSlack holds.
  static constexpr Nanoseconds kYoung = std::chrono::seconds(1);
  static constexpr Nanoseconds kDisputeTime = std::chrono::seconds(1);
  static constexpr Nanoseconds kConfirmTime = std::chrono::milliseconds(500);
  static constexpr std::uint32_t kConfirmations = 4;

  SequenceBudget() = default;
  // At the first number of a writer, whatever it is.
  SequenceBudget(std::int64_t number, SteadyTime now, const Limits& limits);

  // Whether the writer can have reached `number`, which is above 0; notes it if so. Times go up.
  bool Takes(std::int64_t number, SteadyTime now, const Limits& limits);
  // Whether a full budget would allow it; notes nothing.
  bool MayReach(std::int64_t number, SteadyTime now, const Limits& limits) const;

  bool IsYoung(SteadyTime now) const { return now - started_ < kYoung; }
  std::int64_t Highest() const { return highest_; }

 private:
  double SlackAt(SteadyTime now, const Limits& limits) const;
  double RateAt(SteadyTime now) const;
  double Added(SteadyTime since, SteadyTime now) const;
  void Learn(SteadyTime now);
  void TakeBehind(std::int64_t number, SteadyTime now, double slack);
  bool Confirms(std::int64_t number, SteadyTime now, const Limits& limits);

  std::int64_t highest_ = 0;     // believed
  SteadyTime started_{0};        // when the first number came, or the last confirmed jump
  SteadyTime advanced_{0};       // when `highest_` came
  SteadyTime heard_{0};          // when any number came that says where the writer is
  double budget_ = kYoungSlack;  // when it did
  double pace_hz_ = 0;           // of this and the last window of kYoung; 0: not known
  double last_window_hz_ = 0;
  std::int64_t window_number_ = 0;
  SteadyTime window_began_{0};
  SteadyTime disputed_until_{0};
  std::int64_t candidate_ = 0;  // of numbers beyond the plausible ones; 0: none
  std::int64_t first_candidate_ = 0;
  SteadyTime candidate_since_{0};
  SteadyTime candidate_heard_{0};
  std::uint32_t confirmations_ = 0;
};

}  // namespace giveway::link
