// The packet filter reads nothing behind a packet: each one here ends where memory does.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <span>

#include "services/link/packet_filter/packet_filter.h"
#include "tests/support/rtps_packet.h"

namespace giveway::link {
namespace {

using test::PacketBytes;
using test::RtpsPacket;

// Two pages, of which the second cannot be read.
class EndOfMemory {
 public:
  EndOfMemory()
      : page_(static_cast<std::size_t>(sysconf(_SC_PAGESIZE))),
        start_(
            mmap(nullptr, 2 * page_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)) {
    EXPECT_NE(start_, MAP_FAILED);
    EXPECT_EQ(mprotect(Unreadable(), page_, PROT_NONE), 0);
  }
  ~EndOfMemory() { munmap(start_, 2 * page_); }
  EndOfMemory(const EndOfMemory&) = delete;
  EndOfMemory& operator=(const EndOfMemory&) = delete;

  // Filters a copy that ends with the readable page.
  void Filter(const PacketBytes& packet) {
    constexpr std::uint32_t kLoopback = 0x7f000001;
    std::uint8_t* const at = Unreadable() - packet.size();
    std::ranges::copy(packet, at);
    PacketFilter(PacketFilterOptions{.writers = 16})
        .Check({at, packet.size()}, kLoopback, std::chrono::seconds(1000));
  }

 private:
  std::uint8_t* Unreadable() const { return static_cast<std::uint8_t*>(start_) + page_; }

  std::size_t page_;
  void* start_;
};

// A regression: whether a GAP is of discovery was read before whether it is long enough to say so.
TEST(PacketBounds, OfSubmessagesOfEachKindAndLengthNothingBehindThemIsRead) {
  EndOfMemory memory;
  for (const int kind :
       {0x01, 0x06, 0x07, 0x08, 0x09, 0x0c, 0x0d, 0x0e, 0x0f, 0x12, 0x13, 0x15, 0x16}) {
    for (int flags = 0; flags < 8; ++flags) {
      for (std::size_t length = 0; length < 80; ++length) {
        RtpsPacket packet({1, 15, 7}, test::kEProsima, (flags & 1) != 0);
        packet.Add(static_cast<std::uint8_t>(kind), static_cast<std::uint8_t>(flags),
                   PacketBytes(length));
        memory.Filter(packet.Bytes());
      }
    }
  }
}

// Cut anywhere, with the length it had and with the one that is left.
TEST(PacketBounds, OfSoundPacketsThatAreCutNothingBehindThemIsRead) {
  const test::PrefixBytes peer{1, 15, 7};
  const PacketBytes payload{0, 1, 0, 0, 1, 2, 3, 4};
  EndOfMemory memory;
  const auto from_peer = [&] { return RtpsPacket(peer); };
  for (const RtpsPacket& packet :
       {from_peer().Announcement(peer, 1), from_peer().WriterAnnouncement(peer, 0x102, 3),
        from_peer().Gap(test::kPublications, 1, 2, 40),
        from_peer().Gap(test::kUserWriter, 1, 2, 40),
        from_peer().Heartbeat(test::kPublications, 1, 2, 1),
        from_peer().AckNack(test::kPublications, 1, 40, 2),
        from_peer().NackFrag(test::kUserWriter, 6, 1, 32),
        from_peer().DataFrag(test::kUserWriter, 6, 1, 3, 1000, 2184, 40),
        from_peer().Data(test::kPublications, 1, payload), from_peer().Statistics()}) {
    const PacketBytes whole = packet.Bytes();
    for (std::size_t length = 0; length < whole.size(); ++length) {
      PacketBytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
      memory.Filter(cut);
      if (length < 24) continue;
      cut[22] = static_cast<std::uint8_t>(length - 24);
      cut[23] = 0;
      memory.Filter(cut);
    }
  }
}

}  // namespace
}  // namespace giveway::link
