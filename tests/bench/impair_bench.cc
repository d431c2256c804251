// What the impaired transport costs a packet: from the socket's thread to the library's receiver,
// against handing the packet on at once. Packets of 300 bytes from 64 senders in turn.
#include <benchmark/benchmark.h>

#include <array>
#include <chrono>
#include <memory>
#include <vector>

#include "services/link/impairment/impaired_transport.h"
#include "tests/bench/measure.h"

namespace giveway::link {
namespace {

using bench::Median;

constexpr std::size_t kPackets = 4096;
constexpr std::size_t kSenders = 64;

class Receiver final : public transport::TransportReceiverInterface {
 public:
  void OnDataReceived(const rtps::octet* data, const std::uint32_t size, const rtps::Locator_t&,
                      const rtps::Locator_t&) override {
    auto last = data[size - 1];
    benchmark::DoNotOptimize(last);
  }
};

std::vector<rtps::octet> PacketFrom(std::size_t sender) {
  std::vector<rtps::octet> packet(300);
  constexpr std::array<rtps::octet, 4> kMagic = {'R', 'T', 'P', 'S'};
  std::copy(kMagic.begin(), kMagic.end(), packet.begin());
  packet[19] = static_cast<rtps::octet>(sender);  // the last byte of the GUID prefix
  return packet;
}

// Seconds a packet of a batch takes.
template <typename HandOn>
double SecondsPerPacket(const std::vector<std::vector<rtps::octet>>& packets, HandOn&& hand_on) {
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < kPackets; ++i) hand_on(packets[i % kSenders]);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  return took.count() / kPackets;
}

void ImpairedIdle(benchmark::State& state) {
  const auto impairer =
      std::make_shared<Impairer>(Impairment{.seed = 1, .rules = {ImpairmentRule{}}});
  impairer->NameOwn(PrefixBytes{1});
  const auto descriptor =
      MakeImpairedTransport(std::make_shared<transport::UDPv4TransportDescriptor>(), impairer);
  const std::unique_ptr<transport::TransportInterface> made(descriptor->create_transport());
  auto& impaired = dynamic_cast<transport::ChainingTransport&>(*made);
  std::vector<std::vector<rtps::octet>> packets;
  for (std::size_t i = 0; i < kSenders; ++i) packets.push_back(PacketFrom(i));
  Receiver receiver;
  const rtps::Locator_t local, remote;
  std::vector<double> extra_us;
  for (auto _ : state) {
    const double bare_s = SecondsPerPacket(packets, [&](const auto& packet) {
      receiver.OnDataReceived(packet.data(), static_cast<std::uint32_t>(packet.size()), local,
                              remote);
    });
    const double impaired_s = SecondsPerPacket(packets, [&](const auto& packet) {
      impaired.receive(&receiver, packet.data(), static_cast<std::uint32_t>(packet.size()), local,
                       remote);
    });
    extra_us.push_back(1e6 * (impaired_s - bare_s));
    state.SetIterationTime(impaired_s * kPackets);
  }
  state.counters["extra_us"] = Median(extra_us);
}
BENCHMARK(ImpairedIdle)->UseManualTime()->Unit(benchmark::kMicrosecond)->Iterations(500);

}  // namespace
}  // namespace giveway::link
