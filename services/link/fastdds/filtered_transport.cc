#include "services/link/fastdds/filtered_transport.h"

#include <sys/random.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "services/link/fastdds/joined_groups.h"
#include "services/link/fastdds/packets_of_process.h"
#include "services/link/fastdds/topics.h"
#include "services/link/packet_filter/ask_pace.h"
#include "services/link/packet_filter/discovery_list.h"
#include "services/link/packet_filter/fragment_store.h"
#include "services/link/packet_filter/lease_watch.h"
#include "services/link/packet_filter/submessage_check.h"

namespace giveway::link {
namespace {

using std::chrono::steady_clock;

// Counted on the library's threads, read on the loop's. One for all participants: services have
// one.
std::array<std::atomic<std::uint64_t>, kPacketDrops> counted{};

void Count(PacketDrop drop) {
  counted[static_cast<std::size_t>(drop)].fetch_add(1, std::memory_order_relaxed);
}

std::uint64_t RandomSeed() {
  std::uint64_t seed = 0;
  // Without it strangers could find out where writers are kept; nothing else depends on it.
  if (getrandom(&seed, sizeof seed, 0) != sizeof seed) {
    seed = static_cast<std::uint64_t>(steady_clock::now().time_since_epoch().count());
  }
  return seed;
}

std::uint32_t Ipv4Of(const rtps::Locator_t& locator) {
  constexpr std::size_t kIpv4At = 12;
  std::uint32_t address = 0;
  for (std::size_t i = 0; i < 4; ++i) address = address << 8U | locator.address[kIpv4At + i];
  return address;
}

// A receiving thread that had to wait for a packet lets more of them gather. One that finds a
// packet there takes it at once, so that it never falls behind.
void LetPacketsGather(steady_clock::time_point came) {
  constexpr std::chrono::microseconds kWaited(50);  // the library needs less between two packets
  constexpr std::chrono::milliseconds kGather(40);
  thread_local steady_clock::time_point ready;  // for this packet
  if (came - ready > kWaited) std::this_thread::sleep_for(kGather);
  ready = steady_clock::now();
}

// Operators' orders and their answers come in fragments, of which a tool asks for all at once, and
// what another vendor cuts into pieces.
std::size_t FragmentBytes(const PacketFilterOptions& options) {
  constexpr std::size_t kAtOnce = 8;
  constexpr std::size_t kStrangersASample = 4;
  const std::size_t samples = kAtOnce + options.fleet_size + options.strangers / kStrangersASample;
  return samples * options.largest_sample;
}

struct FilteredDescriptor final : transport::ChainingTransportDescriptor {
  FilteredDescriptor(std::shared_ptr<transport::TransportDescriptorInterface> below,
                     const FilteredTransportOptions& of_participant)
      : ChainingTransportDescriptor(std::move(below)), options(of_participant) {}
  transport::TransportInterface* create_transport() const override;

  FilteredTransportOptions options;
};

class FilteredTransport final : public ForwardingTransport {
 public:
  explicit FilteredTransport(const FilteredDescriptor& descriptor)
      : ForwardingTransport(descriptor),
        descriptor_(descriptor),
        filter_(descriptor.options.filter),
        fragments_(FragmentBytes(descriptor.options.filter)) {}

  // The library asks for it at every turn: null ends the process.
  transport::TransportDescriptorInterface* get_configuration() override { return &descriptor_; }

  bool OpenInputChannel(const rtps::Locator_t& local,
                        transport::TransportReceiverInterface* receiver,
                        std::uint32_t max_message_size) override {
    const bool opened = ForwardingTransport::OpenInputChannel(local, receiver, max_message_size);
    if (opened && descriptor_.options.joined_interfaces_only) {
      HearJoinedInterfacesOnly(static_cast<std::uint16_t>(local.port));
    }
    return opened;
  }

  // On the library's threads. What is not sent is repeated by the library: see ask_pace.h.
  bool send(rtps::SenderResource* below, GIVEWAY_SENT bytes, std::uint32_t size,
            rtps::LocatorsIterator* from, rtps::LocatorsIterator* to,
            const std::chrono::steady_clock::time_point& timeout) override {
    HearOwn(FirstBytes(bytes, size));
    const std::optional<PrefixBytes> asked = AskedParticipant(PacedBytes(bytes, size));
    if (asked.has_value() && !MayAsk(*asked)) return true;
    return ForwardingTransport::send(below, bytes, size, from, to, timeout);
  }

  // On the library's threads, one a port.
  void receive(transport::TransportReceiverInterface* receiver, const rtps::octet* bytes,
               std::uint32_t size, const rtps::Locator_t& local,
               const rtps::Locator_t& remote) override {
    const steady_clock::time_point came = steady_clock::now();
    HandOnIfSound(receiver, bytes, size, local, remote);
    if (descriptor_.options.lets_packets_gather) LetPacketsGather(came);
  }

 private:
  void HandOnIfSound(transport::TransportReceiverInterface* receiver, const rtps::octet* bytes,
                     std::uint32_t size, const rtps::Locator_t& local,
                     const rtps::Locator_t& remote) {
    const auto hand_on = [&](Bytes packet) {
      receiver->OnDataReceived(packet.data(), static_cast<std::uint32_t>(packet.size()), local,
                               remote);
    };
    Additional additional;
    const PacketVerdict verdict = Examine({bytes, size}, Ipv4Of(remote), &additional);
    Count(verdict.drop);
    if (verdict.drop != PacketDrop::kNone) return;
    Bytes packet(bytes, verdict.bytes);
    OwnedPacket copy;  // of the few packets of discovery, and of those with fragments
    if (verdict.has_fragments) {
      for (const OwnedPacket& whole : additional.whole) hand_on(whole);
      packet = copy = WithoutFragments(packet);
      if (copy.empty()) return;
    }
    if (verdict.announces || verdict.has_long_gaps) {
      if (!verdict.has_fragments) copy.assign(packet.begin(), packet.end());
      if (verdict.announces) {
        HideTypes(copy);
        ShortenLeases(copy, kLongestLease);
      }
      if (verdict.has_long_gaps) {
        ShortenGaps(copy);
        Count(PacketDrop::kRangeTooLong);
      }
      packet = copy;
    }
    hand_on(packet);
    if (additional.farewell.has_value()) hand_on(*additional.farewell);
  }
  // What is handed on besides a packet.
  struct Additional {
    std::vector<OwnedPacket> whole;  // samples that its fragments complete
    std::optional<Farewell> farewell;
  };
  // Only the port that announcements reach has the reader of farewells.
  PacketVerdict Examine(Bytes packet, std::uint32_t source, Additional* additional) {
    const SteadyTime now(steady_clock::now().time_since_epoch());
    const std::scoped_lock lock(mutex_);
    const PacketVerdict verdict = filter_.Check(packet, source, now);
    if (verdict.drop != PacketDrop::kNone) return verdict;
    const Bytes sound = packet.first(verdict.bytes);
    ask_pace_.Hear(sound);
    if (descriptor_.options.says_farewell && leases_.Hear(sound, now)) {
      additional->farewell = leases_.TakeFarewell(now);
      if (additional->farewell.has_value()) filter_.EndParticipants(*additional->farewell);
    }
    if (verdict.has_fragments) {
      additional->whole = fragments_.Take(sound, filter_.Participants());
    }
    return verdict;
  }
  void HearOwn(Bytes sent) {
    if (!AcknowledgesDiscovery(sent)) return;
    const std::scoped_lock lock(mutex_);
    filter_.HearOwn(sent);
  }
  bool MayAsk(const PrefixBytes& participant) {
    const SteadyTime now(steady_clock::now().time_since_epoch());
    const std::scoped_lock lock(mutex_);
    return ask_pace_.MayAsk(participant, now);
  }

  FilteredDescriptor descriptor_;
  std::mutex mutex_;
  PacketFilter filter_;      // guarded by mutex_
  LeaseWatch leases_;        // guarded by mutex_
  AskPace ask_pace_;         // guarded by mutex_
  FragmentStore fragments_;  // guarded by mutex_
};

transport::TransportInterface* FilteredDescriptor::create_transport() const {
  return new FilteredTransport(*this);  // the library owns it
}

template <typename... Wire>
std::uint32_t LargestOf() {
  return std::max({LargestSize(typename TopicOf<Wire>::Type())...});
}

}  // namespace

std::shared_ptr<transport::TransportDescriptorInterface> MakeFilteredTransport(
    std::shared_ptr<transport::TransportDescriptorInterface> below,
    const FilteredTransportOptions& options) {
  FilteredTransportOptions seeded = options;
  seeded.filter.seed = RandomSeed();
  return std::make_shared<FilteredDescriptor>(std::move(below), seeded);
}

// Types that fit one datagram are never sent in fragments that a smaller bound would refuse.
std::uint32_t LargestSample() {
  constexpr std::uint32_t kDatagram = 65536;
  constexpr std::uint32_t kPadding = 64;
  static const std::uint32_t largest = std::max(
      kDatagram, LargestOf<wire::Beacon, wire::Status, wire::Order, wire::Answer, wire::RangeScan,
                           wire::LidarScan, wire::Roster, wire::Event, wire::Figures>() +
                     kPadding);
  return largest;
}

PacketCounters PacketsOfProcess() {
  PacketCounters counters;
  for (std::size_t i = 0; i < kPacketDrops; ++i) {
    counters.packets[i] = counted[i].load(std::memory_order_relaxed);
  }
  return counters;
}

}  // namespace giveway::link
