// What the packet filter costs a packet, for packets as a fleet of 64 sends them: a beacon, what
// announces it, what is said again of it, and the statistics behind each.
#include <benchmark/benchmark.h>

#include <vector>

#include "services/link/packet_filter/packet_filter.h"
#include "tests/support/rtps_packet.h"

namespace giveway::link {
namespace {

using test::PacketBytes;
using test::RtpsPacket;

constexpr std::uint8_t kSenders = 64;
constexpr std::uint32_t kSource = 0x7f000001;

std::vector<PacketBytes> Packets(std::int64_t number) {
  std::vector<PacketBytes> packets;
  for (std::uint8_t sender = 0; sender < kSenders; ++sender) {
    const test::PrefixBytes prefix{1, 15, sender};
    packets.push_back(RtpsPacket(prefix)
                          .InfoTs()
                          .Data(test::kUserWriter, number, PacketBytes(204))
                          .Statistics()
                          .Bytes());
    packets.push_back(RtpsPacket(prefix)
                          .InfoDst(prefix)
                          .Heartbeat(test::kUserWriter + 0x100, 1, number, 1)
                          .AckNack(test::kUserWriter, number, 0, 0)
                          .Statistics()
                          .Bytes());
    packets.push_back(RtpsPacket(prefix).InfoTs().Announcement(prefix, 1).Statistics().Bytes());
  }
  return packets;
}

void PacketFilterCost(benchmark::State& state) {
  PacketFilter filter({.fleet_size = kSenders});
  const std::vector<PacketBytes> packets = Packets(1);
  SteadyTime now = std::chrono::seconds(1);
  std::uint64_t passed = 0;
  for (auto _ : state) {
    now += std::chrono::milliseconds(50);
    for (const PacketBytes& packet : packets) {
      passed += filter.Check(packet, kSource, now).drop == PacketDrop::kNone ? 1U : 0U;
    }
  }
  const double judged =
      static_cast<double>(state.iterations()) * static_cast<double>(packets.size());
  state.counters["passed"] = static_cast<double>(passed) / judged;
  state.counters["packet_us"] =
      benchmark::Counter(judged / 1e6, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(PacketFilterCost)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace giveway::link
