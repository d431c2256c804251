// What is known of every writer heard: how far its sequence numbers have come, and so which number
// it can have reached by now. Bounded: in a full table the strangers give way first, those heard
// least and longest ago, so that a flood of invented writers never evicts the fleet's own.
//
// A number is plausible up to the highest one seen + kSlack + kRate_hz x the time since; of a
// writer that has been faster all along, up to what it sends in half a second + twice its rate x
// the time since. A writer whose numbers really did jump, because this process lost more than that,
// is believed once it has kept to its new numbers for kConfirmTime and said nothing new by the
// former ones. Of a writer first seen within kAcquaintance any number up to kMostAtFirst is
// plausible: late joiners meet writers of any age, and what such a writer keeps for them may lie
// far apart: of a roster the entries of those who are still there, with GAPs between.
//
// Lower numbers are always plausible, and say nothing of where the writer is: samples and GAPs are
// sent again, and a restarted writer of some vendors keeps its GUID.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "services/types/time.h"

namespace giveway::link {

using WriterGuid = std::array<std::uint8_t, 16>;

class WriterTable {
 public:
  // More than the samples that a tick's burst loses; at 20 Hz three seconds of beacons.
  static constexpr std::int64_t kSlack = 64;
  // Above the rate of any writer of one vehicle; a writer that is faster is seen as often.
  static constexpr std::int64_t kRate_hz = 256;
  // 39 days at 5 Hz, the rate of a reliable writer. The library steps through as many numbers at
  // the first HEARTBEAT of a writer, which takes it 0.1 s.
  static constexpr std::int64_t kMostAtFirst = std::int64_t{1} << 24U;
  // A reliable writer's HEARTBEAT, which says how far it is, comes within it though half are lost.
  static constexpr Nanoseconds kAcquaintance = std::chrono::seconds(5);
  static constexpr Nanoseconds kConfirmTime = std::chrono::milliseconds(500);
  static constexpr std::uint32_t kConfirmations = 4;
  // A writer that was heard as often is no stranger.
  static constexpr std::uint32_t kKnown = 16;

  // Room for at least as many writers. `seed` decides where a writer is kept: strangers must not
  // know it.
  WriterTable(std::size_t writers, std::uint64_t seed);

  // Whether the writer can have reached `number`, which is above 0. Notes it if so.
  bool IsPlausible(const WriterGuid& writer, std::int64_t number, SteadyTime now);
  // Whether it is in the table; noted as heard if so.
  bool Knows(const WriterGuid& writer, SteadyTime now);
  void Add(const WriterGuid& writer, SteadyTime now);
  std::size_t Capacity() const { return lines_.size(); }

 private:
  struct Line {
    WriterGuid guid{};
    std::int64_t first = 0;  // believed, as the next
    std::int64_t highest = 0;
    std::int64_t candidate = 0;  // of numbers beyond the plausible ones; 0: none
    SteadyTime met{0};           // when it was new
    SteadyTime heard_first{0};   // when `first` was
    SteadyTime heard{0};         // when `highest` was, for the first time
    SteadyTime candidate_since{0};
    SteadyTime candidate_heard{0};
    std::uint32_t packets = 0;  // 0: the line is free
    std::uint32_t confirmations = 0;
  };
  static constexpr std::size_t kWays = 8;

  Line* SetOf(const WriterGuid& writer);
  Line* Find(const WriterGuid& writer);
  Line& Insert(const WriterGuid& writer, SteadyTime now);
  static bool KeepsItsPace(const Line& line, std::int64_t number, SteadyTime now);
  static bool Confirms(Line* line, std::int64_t number, SteadyTime now);

  std::vector<Line> lines_;  // sets of kWays
  std::uint64_t seed_;
};

}  // namespace giveway::link
