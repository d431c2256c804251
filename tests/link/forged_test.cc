// Packets that an intruder forges, against real participants: one sample with a sequence number far
// ahead, from any source, permanently stops the library's reader from receiving its writer; one
// statistics submessage ends the process.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "services/link/convert/convert.h"
#include "services/link/fastdds/packets_of_process.h"
#include "services/link/participant.h"
#include "services/link/world_link.h"
#include "tests/link/fleet.h"
#include "tests/support/rtps_packet.h"

namespace giveway::test {
namespace {

namespace rtps = link::rtps;
constexpr VehicleId kFive{5};

// The writers in the partition v5 that are not vehicle 5's own.
class Finder final : public link::DiscoveryListener {
 public:
  void OnWriter(Change change, const rtps::GUID_t& writer,
                const std::vector<std::string>& partitions) override {
    if (change != Change::kFound || partitions.size() != 1) return;
    const std::scoped_lock lock(mutex_);
    if (partitions[0] == "main/v5") vehicle_ = writer.guidPrefix;
    if (partitions[0] == "v5") found_.insert(writer);
  }
  std::vector<rtps::GUID_t> OfTheWorld() {
    const std::scoped_lock lock(mutex_);
    std::vector<rtps::GUID_t> writers;
    for (const rtps::GUID_t& writer : found_) {
      const bool own = vehicle_ == rtps::GuidPrefix_t() || writer.guidPrefix == vehicle_;
      if (!own) writers.push_back(writer);
    }
    return writers;
  }

 private:
  std::mutex mutex_;
  rtps::GuidPrefix_t vehicle_;  // guarded by mutex_, as the next
  std::set<rtps::GUID_t> found_;
};

RangeScan ScanOf(std::uint32_t tick) {
  RangeScan scan;
  scan.vehicle = kFive;
  scan.epoch = WorldEpoch{1};
  scan.tick = Tick{tick};
  return scan;
}

// An RTPS packet with one DATA of `writer`, to whichever reader listens to it.
std::vector<std::uint8_t> ForgedScan(const rtps::GUID_t& writer, std::uint64_t sequence) {
  link::TopicOf<wire::RangeScan>::Type type;
  wire::RangeScan sample = link::ToWire(ScanOf(1));
  rtps::SerializedPayload_t payload(link::SerializedSize(type, &sample) + 8);
  EXPECT_TRUE(link::Serialize(type, &sample, payload));
  std::vector<std::uint8_t> packet = {'R', 'T', 'P', 'S', 2, 3, 1, 15};
  const auto append = [&](const auto* bytes, std::size_t size) {
    packet.insert(packet.end(), bytes, bytes + size);
  };
  const auto append_word = [&](std::uint64_t word, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
      packet.push_back(static_cast<std::uint8_t>(word >> (8 * i)));
    }
  };
  append(writer.guidPrefix.value, 12);
  append_word(0x0515, 2);  // DATA: little-endian, with a payload
  append_word(20 + payload.length, 2);
  append_word(0, 2);
  append_word(16, 2);
  append_word(0, 4);  // any reader
  append(writer.entityId.value, 4);
  append_word(sequence >> 32U, 4);
  append_word(sequence & 0xffff'ffffU, 4);
  append(payload.data, payload.length);
  return packet;
}

// To the port of each of the first participants of the domain.
void SendToAll(const std::vector<std::uint8_t>& packet, std::uint32_t domain) {
  const int sender = socket(AF_INET, SOCK_DGRAM, 0);
  for (std::uint32_t participant = 0; participant < 8; ++participant) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to.sin_port = htons(static_cast<std::uint16_t>(7400 + 250 * domain + 11 + 2 * participant));
    sendto(sender, packet.data(), packet.size(), 0, reinterpret_cast<sockaddr*>(&to), sizeof(to));
  }
  close(sender);
}

// A world that speaks to a vehicle, and what an intruder needs to know of it.
class Forged : public testing::Test {
 protected:
  Forged() {
    world_.OpenRanges(kFive);
    vehicle_.Open(kFive);
    EXPECT_TRUE(Eventually([&] { return Hears(); }));
    EXPECT_TRUE(Eventually([&] { return finder_.OfTheWorld().size() == 1; }));
  }

  bool Hears() {
    world_.SendScan(ScanOf(++tick_));
    return vehicle_.Take(SteadyTime{0}).inputs.scan.has_value();
  }
  rtps::GUID_t Writer() { return finder_.OfTheWorld().at(0); }
  void Send(const std::vector<std::uint8_t>& packet) { SendToAll(packet, options_.domain); }

  const DomainLock domain_;
  const link::LinkOptions options_ = OptionsIn(domain_);
  Finder finder_;
  const link::Participant finding_{options_, "finder", finder_};
  link::WorldLink world_{options_};
  link::VehicleLink vehicle_{options_};
  std::uint32_t tick_ = 1;
};

PrefixBytes PrefixOf(const rtps::GUID_t& guid) {
  PrefixBytes prefix;
  std::copy_n(guid.guidPrefix.value, prefix.size(), prefix.begin());
  return prefix;
}

std::uint64_t Dropped(PacketDrop reason) { return link::PacketsOfProcess().Of(reason); }

// Issue 21, number 15; issue 25.
TEST_F(Forged, AScanFarAheadIsDroppedAndTheVehicleHearsOn) {
  const std::uint64_t before = Dropped(PacketDrop::kSequenceJump);
  Send(ForgedScan(Writer(), std::uint64_t{1} << 40U));
  ASSERT_TRUE(Eventually([&] { return Dropped(PacketDrop::kSequenceJump) > before; }));
  vehicle_.Take(SteadyTime{0});
  EXPECT_TRUE(Eventually([&] { return Hears(); }, std::chrono::seconds(2)));
}

// The library aborts: the death of this process would be the failure.
TEST_F(Forged, StatisticsThatAreNotTheLastSubmessageAreDropped) {
  std::vector<std::uint8_t> packet = RtpsPacket({1, 15, 66}).Statistics().Bytes();
  packet.resize(84);
  const std::uint64_t before = Dropped(PacketDrop::kStatistics);
  Send(packet);
  ASSERT_TRUE(Eventually([&] { return Dropped(PacketDrop::kStatistics) > before; }));
  EXPECT_TRUE(Eventually([&] { return Hears(); }, std::chrono::seconds(2)));
}

// The library would allocate 4 GB.
TEST_F(Forged, AFragmentOfAHugeSampleIsDropped) {
  const std::uint64_t before = Dropped(PacketDrop::kSampleTooLarge);
  Send(RtpsPacket(PrefixOf(Writer())).DataFrag(0x103, 1, 1, 1, 1000, 4'000'000'000, 1000).Bytes());
  ASSERT_TRUE(Eventually([&] { return Dropped(PacketDrop::kSampleTooLarge) > before; }));
  EXPECT_TRUE(Eventually([&] { return Hears(); }, std::chrono::seconds(2)));
}

}  // namespace
}  // namespace giveway::test
