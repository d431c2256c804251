// What the link adds to Fast DDS: sending (conversion, checksum, write) against a bare write of a
// ready sample, and draining (take, conversion, checksum, name check) against a bare take and loan.
// Both run in turns in the same loop on the same endpoints; a ratio is the median over neighbours,
// so that whatever else the machine does falls on both. Waiting for delivery is not counted.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <chrono>
#include <thread>
#include <vector>

#include "services/link/convert/convert.h"
#include "services/link/fastdds/profile_file.h"
#include "services/link/inbox/beacon_inbox.h"
#include "services/link/participant.h"
#include "tests/bench/measure.h"
#include "tests/support/domain_lock.h"

namespace giveway::link {
namespace {

using bench::Median;

constexpr std::uint32_t kBatch = 8;

LinkOptions Options(const test::DomainLock& domain) {
  LinkOptions options;
  options.domain = domain.Domain();
  options.qos = ReadProfileFile(GIVEWAY_QOS_FILE);
  return options;
}

Beacon BeaconOf(std::uint32_t vehicle) {
  Beacon beacon;
  beacon.vehicle = VehicleId{vehicle};
  beacon.boot_epoch = 1;
  beacon.cruise_m_s = 0.3;
  beacon.order = {0, 6, VehicleId{vehicle}};
  return beacon;
}

// Eight vehicles' beacon writers and one reader that hears them all, through UDP on loopback.
class Fleet {
 public:
  Fleet()
      : senders_(Options(domain_), "bench-senders", sender_names_),
        listener_(Options(domain_), "bench-listener", names_),
        reader_(listener_.MakeReader<wire::Beacon>("main/*")),
        inbox_(reader_, names_, listener_.Prefix()) {
    for (std::uint32_t i = 1; i <= kBatch; ++i) {
      writers_.push_back(
          senders_.MakeWriter<wire::Beacon>("main/" + VehiclePartition(VehicleId{i})));
      beacons_.push_back(BeaconOf(i));
      samples_.push_back(ToWire(beacons_.back()));
    }
    Match();
  }

  void SendThroughLink() {
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      ++beacons_[i].seq;
      writers_[i].Write(ToWire(beacons_[i]));
    }
  }
  void SendBare() {
    for (std::uint32_t i = 0; i < kBatch; ++i) writers_[i].Write(samples_[i]);
  }
  std::size_t DrainThroughLink() {
    received_.clear();
    names_.Update();
    inbox_.Drain(SteadyTime{0}, received_);
    return received_.size();
  }
  std::size_t DrainBare() {
    std::size_t taken = 0;
    dds::DataReader& reader = reader_.Entity();
    dds::LoanableSequence<wire::Beacon> samples;
    dds::SampleInfoSeq infos;
    while (Ok(reader.take(samples, infos))) {
      for (int i = 0; i < static_cast<int>(samples.length()); ++i) {
        if (!infos[i].valid_data) continue;
        benchmark::DoNotOptimize(samples[i].seq());
        ++taken;
      }
      reader.return_loan(samples, infos);
    }
    return taken;
  }
  // True once the reader holds a sample of every writer.
  bool WaitForBatch() {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(1);
    while (reader_.Entity().get_unread_count() < kBatch) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::yield();
    }
    return true;
  }

 private:
  void Match() {
    do {
      DrainBare();
      SendBare();
    } while (!WaitForBatch());
    DrainThroughLink();
  }

  test::DomainLock domain_;
  WriterNames sender_names_;
  WriterNames names_;
  Participant senders_;
  Participant listener_;
  Reader<wire::Beacon> reader_;
  BeaconInbox inbox_;
  std::vector<Writer<wire::Beacon>> writers_;
  std::vector<Beacon> beacons_;
  std::vector<wire::Beacon> samples_;
  std::vector<ReceivedBeacon> received_;
};

template <typename Work>
double SecondsOf(Work&& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// One batch sent and drained.
struct Cost {
  double send_s = 0;
  double take_s = 0;
  double Both() const { return send_s + take_s; }
};

Cost ThroughLink(Fleet& fleet) {
  Cost cost;
  cost.send_s = SecondsOf([&] { fleet.SendThroughLink(); });
  fleet.WaitForBatch();
  cost.take_s = SecondsOf([&] { benchmark::DoNotOptimize(fleet.DrainThroughLink()); });
  return cost;
}

Cost Bare(Fleet& fleet) {
  Cost cost;
  cost.send_s = SecondsOf([&] { fleet.SendBare(); });
  fleet.WaitForBatch();
  cost.take_s = SecondsOf([&] { benchmark::DoNotOptimize(fleet.DrainBare()); });
  return cost;
}

void LinkOverhead(benchmark::State& state) {
  Fleet fleet;
  std::vector<double> send_ratio, take_ratio, both_ratio, link_take_s, bare_take_s, bare_send_s;
  bool link_first = false;
  for (auto _ : state) {
    link_first = !link_first;
    Cost link, bare;
    if (link_first) link = ThroughLink(fleet);
    bare = Bare(fleet);
    if (!link_first) link = ThroughLink(fleet);
    send_ratio.push_back(link.send_s / bare.send_s);
    take_ratio.push_back(link.take_s / bare.take_s);
    both_ratio.push_back(link.Both() / bare.Both());
    link_take_s.push_back(link.take_s);
    bare_take_s.push_back(bare.take_s);
    bare_send_s.push_back(bare.send_s);
    state.SetIterationTime(link.Both());
  }
  state.counters["send_ratio"] = Median(send_ratio);
  state.counters["take_ratio"] = Median(take_ratio);
  state.counters["both_ratio"] = Median(both_ratio);
  state.counters["bare_send_us"] = 1e6 * Median(bare_send_s) / kBatch;
  state.counters["bare_take_us"] = 1e6 * Median(bare_take_s) / kBatch;
  state.counters["link_take_us"] = 1e6 * Median(link_take_s) / kBatch;
}
BENCHMARK(LinkOverhead)->UseManualTime()->Unit(benchmark::kMicrosecond)->Iterations(4000);

}  // namespace
}  // namespace giveway::link
