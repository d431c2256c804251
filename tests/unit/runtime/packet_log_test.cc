#include "services/runtime/packet_log.h"

#include <gtest/gtest.h>

#include <set>

namespace giveway {
namespace {

using std::chrono::seconds;

PacketCounters Counted(std::uint64_t passed, std::uint64_t malformed, std::uint64_t jumps) {
  PacketCounters counters;
  counters.packets[static_cast<std::size_t>(PacketDrop::kNone)] = passed;
  counters.packets[static_cast<std::size_t>(PacketDrop::kMalformed)] = malformed;
  counters.packets[static_cast<std::size_t>(PacketDrop::kSequenceJump)] = jumps;
  return counters;
}

TEST(PacketLog, SaysNothingWhereNothingIsDropped) {
  PacketLog log;
  EXPECT_EQ(log.Note(Counted(1000, 0, 0), seconds(1)), std::nullopt);
}

TEST(PacketLog, SaysTheFirstDropAtOnceAndThenALineAMinute) {
  PacketLog log;
  EXPECT_EQ(log.Note(Counted(10, 1, 0), seconds(1)),
            "packet filter: dropped malformed 1; handed on 10");
  EXPECT_EQ(log.Note(Counted(20, 500, 3), seconds(60)), std::nullopt);
  EXPECT_EQ(log.Note(Counted(30, 501, 4), seconds(61)),
            "packet filter: dropped malformed 500, sequence_jump 4; handed on 20");
  EXPECT_EQ(log.Note(Counted(40, 501, 4), seconds(200)), std::nullopt);
}

TEST(PacketDrop, EachHasANameOfItsOwn) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < kPacketDrops; ++i) names.insert(Name(static_cast<PacketDrop>(i)));
  EXPECT_EQ(names.size(), kPacketDrops);
  EXPECT_FALSE(names.contains("unknown"));
}

}  // namespace
}  // namespace giveway
