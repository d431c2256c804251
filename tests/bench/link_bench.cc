// What the link adds to Fast DDS: sending (conversion, checksum, write) against a bare write of a
// ready sample, and draining (take, conversion, checksum, name check) against a bare take and loan.
// Both sides of a pair run in turns in the same loop, on the same endpoints; the figure is the
// median of the ratio of neighbours, so that what else the machine does falls on both.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

#include "services/link/beacon_inbox.h"
#include "services/link/convert.h"
#include "services/link/participant.h"
#include "tests/support/domain_lock.h"

namespace giveway::link {
namespace {

constexpr std::uint32_t kBatch = 8;

LinkOptions Options(const test::DomainLock& domain) {
  LinkOptions options;
  options.domain = domain.Domain();
  options.qos_file = GIVEWAY_QOS_FILE;
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
    reader_.TakeEach([&](const wire::Beacon& sample, const dds::SampleInfo&) {
      benchmark::DoNotOptimize(sample.seq());
      ++taken;
    });
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

double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Collects pairs and reports them as counters of one benchmark.
class Pairs {
 public:
  void Add(double link_s, double bare_s) {
    link_.push_back(link_s);
    bare_.push_back(bare_s);
    ratio_.push_back(link_s / bare_s);
  }
  void Report(benchmark::State& state) const {
    state.counters["link_us"] = 1e6 * Median(link_) / kBatch;
    state.counters["bare_us"] = 1e6 * Median(bare_) / kBatch;
    state.counters["ratio"] = Median(ratio_);
  }

 private:
  std::vector<double> link_, bare_, ratio_;
};

void LinkSend(benchmark::State& state) {
  Fleet fleet;
  Pairs pairs;
  bool link_first = false;
  for (auto _ : state) {
    link_first = !link_first;
    double link_s = 0;
    double bare_s = 0;
    for (const bool through_link : {link_first, !link_first}) {
      const double took = through_link ? SecondsOf([&] { fleet.SendThroughLink(); })
                                       : SecondsOf([&] { fleet.SendBare(); });
      (through_link ? link_s : bare_s) = took;
      fleet.WaitForBatch();
      fleet.DrainBare();
    }
    pairs.Add(link_s, bare_s);
    state.SetIterationTime(link_s);
  }
  pairs.Report(state);
}
BENCHMARK(LinkSend)->UseManualTime()->Unit(benchmark::kMicrosecond)->Iterations(4000);

void LinkTake(benchmark::State& state) {
  Fleet fleet;
  Pairs pairs;
  bool link_first = false;
  for (auto _ : state) {
    link_first = !link_first;
    double link_s = 0;
    double bare_s = 0;
    std::size_t taken = 0;
    for (const bool through_link : {link_first, !link_first}) {
      fleet.SendBare();
      if (!fleet.WaitForBatch()) continue;
      const double took =
          SecondsOf([&] { taken += through_link ? fleet.DrainThroughLink() : fleet.DrainBare(); });
      (through_link ? link_s : bare_s) = took;
    }
    if (taken == 2 * kBatch) pairs.Add(link_s, bare_s);
    state.SetIterationTime(link_s);
  }
  pairs.Report(state);
}
BENCHMARK(LinkTake)->UseManualTime()->Unit(benchmark::kMicrosecond)->Iterations(4000);

}  // namespace
}  // namespace giveway::link
