#include "services/link/impairment/endless_gap.h"

#include <gtest/gtest.h>

#include <vector>

namespace giveway::link {
namespace {

using Packet = std::vector<std::uint8_t>;

void Append(std::uint64_t word, std::size_t size, bool little_endian, Packet* to) {
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t place = little_endian ? i : size - 1 - i;
    to->push_back(static_cast<std::uint8_t>(word >> (8 * place)));
  }
}

void AppendNumber(std::uint64_t number, bool little_endian, Packet* to) {
  Append(number >> 32U, 4, little_endian, to);
  Append(number & 0xffff'ffffU, 4, little_endian, to);
}

// A timestamp submessage, as most packets begin with, and a GAP.
Packet WithGap(std::uint64_t first, std::uint64_t behind, bool little_endian) {
  Packet packet(20);
  const std::uint8_t flags = little_endian ? 1 : 0;
  packet.insert(packet.end(), {0x09, flags});
  Append(8, 2, little_endian, &packet);
  packet.resize(packet.size() + 8);
  packet.insert(packet.end(), {0x08, flags});
  Append(28, 2, little_endian, &packet);
  packet.resize(packet.size() + 8);  // reader and writer
  AppendNumber(first, little_endian, &packet);
  AppendNumber(behind, little_endian, &packet);
  Append(0, 4, little_endian, &packet);  // no single ones behind
  return packet;
}

TEST(EndlessGap, IsOneOfMoreSamplesThanAnyWriterKeeps) {
  for (const bool little_endian : {false, true}) {
    EXPECT_FALSE(HasEndlessGap(WithGap(1, 2, little_endian)));
    EXPECT_FALSE(HasEndlessGap(WithGap(1, 100'001, little_endian)));
    EXPECT_TRUE(HasEndlessGap(WithGap(1, 100'002, little_endian)));
    EXPECT_TRUE(HasEndlessGap(WithGap(1, std::uint64_t{1} << 40U, little_endian)));
    EXPECT_TRUE(HasEndlessGap(WithGap(std::uint64_t{1} << 63U, 2, little_endian)));
    EXPECT_FALSE(HasEndlessGap(WithGap(2, std::uint64_t{1} << 63U, little_endian)));
  }
}

TEST(EndlessGap, ReadsNothingBehindTheEndOfAPacket) {
  const Packet whole = WithGap(1, std::uint64_t{1} << 40U, true);
  constexpr std::size_t kToTheNumbers = 20 + 12 + 4 + 24;
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    const Packet cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(HasEndlessGap(cut), size >= kToTheNumbers) << size;
  }
}

TEST(EndlessGap, IsFoundInTheLastSubmessageThatSaysNoLength) {
  Packet packet = WithGap(1, std::uint64_t{1} << 40U, true);
  packet[20 + 12 + 2] = 0;
  EXPECT_TRUE(HasEndlessGap(packet));
}

}  // namespace
}  // namespace giveway::link
