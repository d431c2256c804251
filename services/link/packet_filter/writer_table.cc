#include "services/link/packet_filter/writer_table.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <utility>

namespace giveway::link {
namespace {

constexpr double kCountsAtLeast = 64;
constexpr double kCountsAVehicle = 8;

std::uint64_t Mixed(std::uint64_t word) {
  word ^= word >> 32U;
  word *= 0xd6e8'feb8'6659'fd93U;
  return word ^ word >> 32U;
}

}  // namespace

WriterTable::WriterTable(std::size_t writers, std::uint64_t seed, std::uint32_t fleet_size,
                         bool of_all_bodies)
    : lines_(std::bit_ceil(std::max(writers, kWays))),
      seed_(seed | 1),
      count_limits_{.least = kCountsAtLeast + kCountsAVehicle * fleet_size,
                    .seconds = 0.5,
                    .are_shared = true} {
  sample_limits_.may_grow = of_all_bodies;
}

WriterTable::Line* WriterTable::SetOf(const WriterGuid& writer) {
  std::uint64_t high, low;
  std::memcpy(&high, writer.data(), sizeof high);
  std::memcpy(&low, writer.data() + sizeof high, sizeof low);
  const std::uint64_t hash = Mixed(Mixed(high ^ seed_) + low * seed_);
  return &lines_[(hash & (lines_.size() / kWays - 1)) * kWays];
}

WriterTable::Line* WriterTable::Find(const WriterGuid& writer) {
  Line* const set = SetOf(writer);
  for (std::size_t i = 0; i < kWays; ++i) {
    if (set[i].packets != 0 && set[i].guid == writer) return &set[i];
  }
  return nullptr;
}

// In the place of a stranger, if there is one; of several, of the one silent longest.
WriterTable::Line& WriterTable::Insert(const WriterGuid& writer, SteadyTime now) {
  Line* const set = SetOf(writer);
  const auto worth = [](const Line& line) {
    const int rank = line.packets == 0 ? 0 : line.packets < kKnown ? 1 : 2;
    return std::pair(rank, line.heard);
  };
  Line& line = *std::min_element(set, set + kWays,
                                 [&](const Line& a, const Line& b) { return worth(a) < worth(b); });
  line = {};
  line.guid = writer;
  line.met = line.heard = now;
  line.packets = 1;
  return line;
}

bool WriterTable::IsPlausible(const WriterGuid& writer, std::int64_t number, Statement by,
                              SteadyTime now) {
  Line* line = Find(writer);
  if (line == nullptr) {
    line = &Insert(writer, now);
    line->is_reliable = by == Statement::kRange;
    line->budget = SequenceBudget(number <= kMostAtFirst ? number : 0, now, LimitsOf(*line, by));
    if (number <= kMostAtFirst) return true;
  }
  if (line->packets != std::numeric_limits<std::uint32_t>::max()) ++line->packets;
  line->heard = now;
  if (Takes(line, number, by, now)) return true;
  if (number > kMostAtFirst || !IsNew(*line, by, now)) return false;
  line->budget = SequenceBudget(number, now, LimitsOf(*line, by));
  return true;
}

bool WriterTable::IsNew(const Line& line, Statement by, SteadyTime now) {
  const bool has_heartbeats = line.is_reliable || by == Statement::kRange;
  return now - line.met <= (has_heartbeats ? kAcquaintance : kAcquaintanceOfSamples);
}

const SequenceBudget::Limits& WriterTable::LimitsOf(const Line& line, Statement by) const {
  if (by == Statement::kCount) return count_limits_;
  return line.is_reliable ? kReliableLimits : sample_limits_;
}

bool WriterTable::Takes(Line* line, std::int64_t number, Statement by, SteadyTime now) const {
  if (by == Statement::kCount) return line->budget.Takes(number, now, LimitsOf(*line, by));
  if (by == Statement::kRange && IsNew(*line, by, now)) line->is_reliable = true;
  if (line->is_reliable || by == Statement::kRange) {
    const std::int64_t known = line->budget.Highest();
    if (number - known > (known == 0 ? kMostOfOld : kMostAtFirst)) return false;
  }
  if (by == Statement::kRange && !line->is_reliable) {
    return line->budget.MayReach(number, now, kRangeLimits);
  }
  return line->budget.Takes(number, now, LimitsOf(*line, by));
}

}  // namespace giveway::link
