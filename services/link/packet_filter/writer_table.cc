#include "services/link/packet_filter/writer_table.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <utility>

namespace giveway::link {
namespace {

std::uint64_t Mixed(std::uint64_t word) {
  word ^= word >> 32U;
  word *= 0xd6e8'feb8'6659'fd93U;
  return word ^ word >> 32U;
}

// How far numbers may have come in that time, the slack included.
std::int64_t Growth(Nanoseconds time) {
  constexpr std::int64_t kLongest_s = 100 * 24 * 3600;
  const std::int64_t whole_s = time / std::chrono::seconds(1);
  if (whole_s >= kLongest_s) return WriterTable::kRate_hz * kLongest_s;
  const std::int64_t time_ns = std::max<std::int64_t>(time.count(), 0);
  constexpr std::int64_t kApart_ns = 1'000'000'000 / WriterTable::kRate_hz;
  return WriterTable::kSlack + time_ns / kApart_ns;
}

}  // namespace

WriterTable::WriterTable(std::size_t writers, std::uint64_t seed)
    : lines_(std::bit_ceil(std::max(writers, kWays))), seed_(seed | 1) {}

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
    return std::pair(rank, std::max(line.heard, line.candidate_heard));
  };
  Line& line = *std::min_element(set, set + kWays,
                                 [&](const Line& a, const Line& b) { return worth(a) < worth(b); });
  line = {};
  line.guid = writer;
  line.heard = line.heard_first = line.met = now;
  line.packets = 1;
  return line;
}

bool WriterTable::IsPlausible(const WriterGuid& writer, std::int64_t number, SteadyTime now) {
  Line* line = Find(writer);
  if (line == nullptr) {
    line = &Insert(writer, now);
    if (number <= kMostAtFirst) {
      line->first = line->highest = number;
      return true;
    }
  }
  if (line->packets != std::numeric_limits<std::uint32_t>::max()) ++line->packets;
  if (number <= line->highest) return true;
  const bool follows =
      number - line->highest <= Growth(now - line->heard) || KeepsItsPace(*line, number, now);
  if (!follows) {
    const bool is_new = number <= kMostAtFirst && now - line->met <= kAcquaintance;
    if (!is_new && !Confirms(line, number, now)) return false;
    line->first = number;
    line->heard_first = now;
  }
  line->highest = number;
  line->heard = now;
  line->candidate = 0;
  return true;
}

// Of a writer that is faster than most: the world's of all bodies' poses.
bool WriterTable::KeepsItsPace(const Line& line, std::int64_t number, SteadyTime now) {
  constexpr Nanoseconds kLeast = std::chrono::seconds(1);
  const double time_s = Seconds(std::max(line.heard - line.heard_first, kLeast));
  const double pace_hz = static_cast<double>(line.highest - line.first) / time_s;
  const double since_s = Seconds(now - line.heard);
  return static_cast<double>(number - line.highest) <= pace_hz * (0.5 + 2 * since_s);
}

// Whether that is how its numbers go now: it has kept to it.
bool WriterTable::Confirms(Line* line, std::int64_t number, SteadyTime now) {
  const bool goes_on = line->candidate != 0 && number >= line->candidate &&
                       number - line->candidate <= Growth(now - line->candidate_heard);
  if (!goes_on) {
    line->candidate_since = now;
    line->confirmations = 0;
  }
  line->candidate = number;
  line->candidate_heard = now;
  ++line->confirmations;
  return line->confirmations >= kConfirmations && now - line->candidate_since >= kConfirmTime;
}

bool WriterTable::Knows(const WriterGuid& writer, SteadyTime now) {
  Line* const line = Find(writer);
  if (line == nullptr) return false;
  line->heard = now;
  if (line->packets != std::numeric_limits<std::uint32_t>::max()) ++line->packets;
  return true;
}

void WriterTable::Add(const WriterGuid& writer, SteadyTime now) { Insert(writer, now); }

}  // namespace giveway::link
