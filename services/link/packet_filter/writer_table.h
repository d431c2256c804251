// What is known of every writer heard: how far its numbers have come (sequence_budget.h), and so
// which number it can have reached by now. Bounded: in a full table the strangers give way first,
// those heard least and longest ago, so that a flood of invented writers never evicts the fleet's
// own.
//
// Of a writer that is new any number up to kMostAtFirst is plausible: late joiners meet writers of
// any age, and what such a writer keeps for them may lie far apart: of a roster the entries of
// the vehicles that are still there, with GAPs between.
//
// A writer of which a HEARTBEAT or GAP came while it was new is a reliable one: what readers of it
// lose is sent again, and it may write many samples at once. Of all others a sample may only be
// a few numbers ahead, because readers that take it skip the true ones up to it; and what their
// HEARTBEATs say, which their readers ignore, moves nothing.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "services/link/packet_filter/sequence_budget.h"
#include "services/types/time.h"

namespace giveway::link {

using WriterGuid = std::array<std::uint8_t, 16>;

// By what a number is stated.
enum class Statement : std::uint8_t {
  kSample,  // DATA, DATA_FRAG
  kRange,   // HEARTBEAT, GAP: what there is
  kCount    // the count of a HEARTBEAT, ACKNACK or NACK_FRAG
};

class WriterTable {
 public:
  // 0.4 s of beacons at 20 Hz.
  static constexpr SequenceBudget::Limits kSampleLimits{.least = 8, .seconds = 0.2};
  // An event a vehicle at once.
  static constexpr SequenceBudget::Limits kReliableLimits{
      .least = 256, .seconds = 0.5, .sends_again = true};
  static constexpr SequenceBudget::Limits kRangeLimits{.least = 64, .seconds = 0.5};
  // 39 days at 5 Hz, the rate of a reliable writer. The library steps through as many numbers at
  // the first HEARTBEAT of a writer, which takes it 0.1 s.
  static constexpr std::int64_t kMostAtFirst = std::int64_t{1} << 24U;
  // How far a reliable writer may be ahead once it has kept to that for a while: of one never
  // heard, 1.7 years at 5 Hz, 1.6 s of stepping; else no more than a new one.
  static constexpr std::int64_t kMostOfOld = std::int64_t{1} << 28U;
  // How long a writer is new. A reliable one's HEARTBEAT, which says how far it is, comes within it
  // though half are lost; of any other a sample does.
  static constexpr Nanoseconds kAcquaintance = std::chrono::seconds(5);
  static constexpr Nanoseconds kAcquaintanceOfSamples = std::chrono::seconds(1);
  // A writer that was heard as often is no stranger.
  static constexpr std::uint32_t kKnown = 16;

  // Holds at least so many writers. `seed` decides where a writer is kept: strangers must not
  // know it. A process is sent HEARTBEATs and ACKNACKs between those that a peer sends to others,
  // which it counts alike: `fleet_size` decides how far counts step at once. `of_all_bodies`: it
  // receives samples of every body of the fleet from one writer, and of more with each that joins.
  WriterTable(std::size_t writers, std::uint64_t seed, std::uint32_t fleet_size = 0,
              bool of_all_bodies = false);

  // Whether the writer can have reached `number`, which is above 0. Notes it if so. Counts are
  // kept under GUIDs of their own.
  bool IsPlausible(const WriterGuid& writer, std::int64_t number, Statement by, SteadyTime now);
  std::size_t Capacity() const { return lines_.size(); }

 private:
  struct Line {
    WriterGuid guid{};
    SequenceBudget budget;
    SteadyTime met{0};
    SteadyTime heard{0};        // when anything came, plausible or not
    std::uint32_t packets = 0;  // 0: the line is free
    bool is_reliable = false;
  };
  static constexpr std::size_t kWays = 8;

  Line* SetOf(const WriterGuid& writer);
  Line* Find(const WriterGuid& writer);
  Line& Insert(const WriterGuid& writer, SteadyTime now);
  static bool IsNew(const Line& line, Statement by, SteadyTime now);
  bool Takes(Line* line, std::int64_t number, Statement by, SteadyTime now) const;
  const SequenceBudget::Limits& LimitsOf(const Line& line, Statement by) const;

  std::vector<Line> lines_;  // sets of kWays
  std::uint64_t seed_;
  SequenceBudget::Limits count_limits_;
  SequenceBudget::Limits sample_limits_ = kSampleLimits;
};

}  // namespace giveway::link
