// Vehicles that fall silent, leave and come back: each is named, and one that is gone stays gone.
#include <gmock/gmock.h>

#include <atomic>
#include <map>

#include "services/link/fastdds/dropped_writers.h"
#include "services/link/fastdds/library_log.h"
#include "services/link/participant.h"
#include "tests/link/fleet.h"
#include "tests/link/raw_vehicle.h"

namespace giveway::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

constexpr VehicleId kListener{1000};

TEST(Departures, OfThreeVehiclesKilledAtOnceAreEachNamed) {
  const DomainLock domain;
  const link::LinkOptions options = OptionsIn(domain);
  link::VehicleLink listener(options);
  listener.Open(kListener);
  ReceptionMonitor monitor(listener);
  std::vector<std::unique_ptr<BeaconingProcess>> fleet;
  for (std::uint32_t id = 1; id <= 5; ++id) {
    fleet.push_back(std::make_unique<BeaconingProcess>(options, VehicleId{id}));
  }
  // A miss is reported once: one of the start, on a busy machine, would take the place of that of
  // the kill.
  ASSERT_TRUE(Eventually([&] {
    monitor.Forget();
    Repeat(milliseconds(200), [&] { monitor.Listen(); });
    return monitor.Heard().size() == 5 && monitor.EventsOf(QosEventKind::kDeadlineMissed).empty() &&
           monitor.EventsOf(QosEventKind::kLivelinessLost).empty();
  }));
  monitor.Forget();
  for (const std::size_t i : {1U, 2U, 4U}) fleet[i]->Kill();
  const std::vector<VehicleId> killed{VehicleId{2}, VehicleId{3}, VehicleId{5}};
  const auto times_told = [&](QosEventKind kind, VehicleId id) {
    const std::vector<VehicleId> events = monitor.EventsOf(kind);
    return std::count(events.begin(), events.end(), id);
  };
  for (const QosEventKind kind : {QosEventKind::kLivelinessLost, QosEventKind::kDeadlineMissed}) {
    for (const VehicleId id : killed) {
      EXPECT_TRUE(Eventually(
          [&] {
            monitor.Listen();
            return times_told(kind, id) > 0;
          },
          seconds(5)))
          << Number(id);
    }
  }
  // An event is reported once: the library repeats those of the dead, the link does not.
  monitor.Forget();
  Repeat(milliseconds(1000), [&] { monitor.Listen(); });
  for (const VehicleId id : killed) {
    EXPECT_EQ(times_told(QosEventKind::kDeadlineMissed, id), 0) << Number(id);
    EXPECT_EQ(times_told(QosEventKind::kLivelinessLost, id), 0) << Number(id);
  }
  // The living are still heard.
  monitor.Forget();
  EXPECT_TRUE(Eventually([&] {
    monitor.Listen();
    return monitor.Heard().size() == 2;
  }));
  EXPECT_THAT(monitor.Heard(), UnorderedElementsAre(VehicleId{1}, VehicleId{4}));
}

TEST(Departures, OfFiftyVehiclesLeaveThePublishedCountersStill) {
  const DomainLock domain;
  const link::LinkOptions options = OptionsIn(domain);
  RawListener listener(options);
  std::uint32_t id = 0;
  // Forty leave in good order, ten are killed and leave when their participants' lease ends.
  for (int batch = 0; batch < 4; ++batch) {
    std::vector<std::unique_ptr<RawSender>> fleet;
    const std::uint32_t first = id + 1;
    for (int i = 0; i < 10; ++i) {
      fleet.push_back(std::make_unique<RawSender>(options, "main/v" + std::to_string(++id)));
    }
    ASSERT_TRUE(Eventually([&, seq = 0U]() mutable {
      ++seq;
      for (std::uint32_t i = 0; i < 10; ++i) {
        fleet[i]->Send(link::ToWire(BeaconFrom(VehicleId{first + i}, seq).beacon));
      }
      listener.Listen();
      return listener.Matched() == 10 && listener.Vehicles().size() == id;
    }));
  }
  std::vector<std::unique_ptr<BeaconingProcess>> processes;
  for (int i = 0; i < 10; ++i) {
    processes.push_back(std::make_unique<BeaconingProcess>(options, VehicleId{++id}));
  }
  ASSERT_TRUE(Eventually([&] {
    listener.Listen();
    return listener.Matched() == 10 && listener.Vehicles().size() == 50;
  }));
  for (auto& process : processes) process->Kill();
  ASSERT_TRUE(Eventually(
      [&] {
        listener.Listen();
        return listener.Matched() == 0;
      },
      seconds(30)));
  EXPECT_EQ(listener.EventCount(QosEventKind::kMatched), 50U);
  EXPECT_EQ(listener.EventCount(QosEventKind::kUnmatched), 50U);
  EXPECT_GE(listener.EventCount(QosEventKind::kLivelinessLost), 10U);

  // No events of departed vehicles are reported, and they cost nothing: the library repeats the
  // miss of an instance every 150 ms for as long as it has it, and has one left of fifty.
  const std::size_t events = listener.EventCount();
  const std::size_t raw = listener.RawMisses();
  Repeat(milliseconds(1500), [&] { listener.Listen(); });
  EXPECT_EQ(listener.EventCount(), events);
  EXPECT_LE(listener.RawMisses() - raw, 30U) << "of 500, were all repeated";

  // It still watches those who come.
  auto late = std::make_unique<BeaconingProcess>(options, VehicleId{++id});
  ASSERT_TRUE(Eventually([&] {
    listener.Listen();
    return listener.Vehicles().contains(VehicleId{id});
  }));
  const std::size_t before = listener.RawMissesOf(VehicleId{id});
  late->Kill();
  EXPECT_TRUE(Eventually([&] {
    listener.Listen();
    return listener.RawMissesOf(VehicleId{id}) > before;
  })) << "the library stopped watching deadlines";
}

class WriterCount final : public link::DiscoveryListener {
 public:
  void OnWriter(Change change, const link::rtps::GUID_t&,
                const std::vector<std::string>&) override {
    if (change == Change::kFound) found_ = true;
    if (change == Change::kGone) gone_ = true;
  }
  bool Found() const { return found_; }
  bool Gone() const { return gone_; }

 private:
  std::atomic<bool> found_{false};
  std::atomic<bool> gone_{false};
};

// The library keeps a record of each writer whose participant it drops for its lease, permanently:
// a world grew by 370 bytes with every kill -9 of a vehicle. With 2.9.1 they are switched off.
TEST(Departures, OfKilledVehiclesLeaveNoRecordInTheLibrary) {
  const DomainLock domain;
  const link::LinkOptions options = OptionsIn(domain);
  WriterCount writers;
  const link::Participant participant(options, "counts", writers);
  BeaconingProcess killed(options, VehicleId{1});
  ASSERT_TRUE(Eventually([&] { return writers.Found(); }));
  killed.Kill();
  ASSERT_TRUE(Eventually([&] { return writers.Gone(); }, seconds(20)));
  EXPECT_TRUE(link::ForgetsDroppedWriters() || writers.Dropped() == 0) << writers.Dropped();
  EXPECT_EQ(link::ForgetsDroppedWriters(), link::kLibraryMajor == 2);
}

// One that had its whole history read at once and then fell silent was drained, and missed for
// ever.
TEST(Departures, OfVehiclesWhoseHistoryWasAllNewLeaveNoInstance) {
  const DomainLock domain;
  const link::LinkOptions options = OptionsIn(domain);
  RawListener listener(options);
  const auto missed_of_four = [&listener] {
    std::size_t vehicles = 0;
    std::map<VehicleId, std::size_t> before;
    for (std::uint32_t id = 1; id <= 4; ++id) {
      before[VehicleId{id}] = listener.RawMissesOf(VehicleId{id});
    }
    Repeat(milliseconds(400), [&] { listener.Listen(); });
    for (const auto& [vehicle, misses] : before) {
      if (listener.RawMissesOf(vehicle) > misses) ++vehicles;
    }
    return vehicles;
  };
  {
    std::vector<std::unique_ptr<RawSender>> fleet;
    for (int i = 1; i <= 4; ++i) {
      fleet.push_back(std::make_unique<RawSender>(options, "main/v" + std::to_string(i)));
    }
    std::uint32_t seq = 0;
    const auto send = [&] {
      ++seq;
      for (std::uint32_t i = 0; i < 4; ++i) {
        fleet[i]->Send(link::ToWire(BeaconFrom(VehicleId{i + 1}, seq).beacon));
      }
    };
    ASSERT_TRUE(Eventually([&] {
      send();
      listener.Listen();
      return listener.Matched() == 4 && listener.Vehicles().size() == 4;
    }));
    // More than the history holds, before the listener's next Listen.
    for (int i = 0; i < 12; ++i) send();
    Repeat(milliseconds(100), [&] { listener.FollowMatches(); });
    ASSERT_TRUE(Eventually([&] {
      listener.Listen();
      return missed_of_four() == 4U;
    }));
  }
  ASSERT_TRUE(Eventually([&] {
    listener.Listen();
    return listener.Matched() == 0;
  }));
  // The one that the library's timer is set for stays.
  EXPECT_TRUE(Eventually([&] { return missed_of_four() <= 1; }, seconds(5)));
}

// As an observer hears them. No timer finds them there, and no listener removes them.
TEST(Departures, OfVehiclesHeardWithoutADeadlineLeaveNoInstance) {
  const DomainLock domain;
  link::LinkOptions options = OptionsIn(domain);
  options.requests_no_times = true;
  RawListener listener(options);
  {
    RawSender one(options, "main/v1");
    RawSender two(options, "main/v2");
    ASSERT_TRUE(Eventually([&, seq = 0U]() mutable {
      ++seq;
      one.Send(link::ToWire(BeaconFrom(VehicleId{1}, seq).beacon));
      two.Send(link::ToWire(BeaconFrom(VehicleId{2}, seq).beacon));
      listener.Listen();
      return listener.Vehicles().size() == 2;
    }));
    Repeat(milliseconds(400), [&] { listener.Listen(); });
  }
  EXPECT_EQ(listener.EventCount(QosEventKind::kDeadlineMissed), 0U);
  EXPECT_EQ(listener.EventCount(QosEventKind::kLivelinessLost), 0U);
  ASSERT_TRUE(Eventually([&] {
    listener.FollowMatches();
    return listener.Matched() == 0;
  }));
  EXPECT_EQ(listener.Departed(), 2U);
  for (int turn = 0; turn < 40; ++turn) listener.Listen();
  EXPECT_EQ(listener.Departed(), 0U);
}

// Issue 21, number 22: the library removed the instance that its timer was set for, and no deadline
// of the reader was watched any more.
TEST(Departures, OfAVehicleThatWasNotHeardToTheEndLeavesTheDeadlinesWatched) {
  const DomainLock domain;
  const link::LinkOptions options = OptionsIn(domain);
  RawListener listener(options);
  RawSender staying(options, "main/v6");
  std::uint32_t seq = 0;
  const auto send = [&seq](RawSender& sender, std::uint32_t id) {
    sender.Send(link::ToWire(BeaconFrom(VehicleId{id}, ++seq).beacon));
  };
  {
    RawSender leaving(options, "main/v5");
    ASSERT_TRUE(Eventually([&] {
      send(leaving, 5);
      send(staying, 6);
      listener.Listen();
      return listener.Vehicles().size() == 2;
    }));
    // Of the two, the timer is set for the one that says nothing more.
    send(leaving, 5);
    Repeat(milliseconds(100), [&] { send(staying, 6); });
  }
  ASSERT_TRUE(Eventually([&] {
    send(staying, 6);
    listener.FollowMatches();
    return listener.Matched() == 1;
  }));
  const std::uint32_t lost = link::DeadlineWatchesLost();
  Repeat(milliseconds(500), [&] {
    send(staying, 6);
    listener.Listen();
  });
  EXPECT_TRUE(Eventually(
      [&] {
        listener.Listen();
        return listener.RawMissesOf(VehicleId{6}) > 0;
      },
      seconds(3)))
      << "the library stopped watching deadlines";
  EXPECT_EQ(link::DeadlineWatchesLost(), lost);
}

TEST(Departures, ARestartedVehicleIsHeardAgainAndMissedAgain) {
  const DomainLock domain;
  const link::LinkOptions options = OptionsIn(domain);
  link::VehicleLink listener(options);
  listener.Open(kListener);
  ReceptionMonitor monitor(listener);
  const auto hear_it = [&] {
    return Eventually([&] {
      monitor.Listen();
      return monitor.Heard().contains(VehicleId{5});
    });
  };
  std::uint64_t first_writer = 0;
  {
    const BeaconingProcess first_life(options, VehicleId{5});
    ASSERT_TRUE(hear_it());
    first_writer = monitor.Beacons().back().writer;
  }
  ASSERT_TRUE(Eventually([&] {
    monitor.Listen();
    return !monitor.EventsOf(QosEventKind::kLivelinessLost).empty() &&
           !monitor.EventsOf(QosEventKind::kDeadlineMissed).empty();
  }));
  monitor.Forget();
  {
    // At once, while the dead participant is still remembered.
    const BeaconingProcess second_life(options, VehicleId{5});
    ASSERT_TRUE(hear_it());
    EXPECT_NE(monitor.Beacons().back().writer, first_writer);
  }
  EXPECT_TRUE(Eventually([&] {
    monitor.Listen();
    return !monitor.EventsOf(QosEventKind::kDeadlineMissed).empty();
  }));
  EXPECT_EQ(monitor.EventsOf(QosEventKind::kDeadlineMissed).front(), VehicleId{5});
}

TEST(Departures, AVehicleThatPausesIsMissedOnceAndComesBack) {
  const DomainLock domain;
  Beaconing sender(OptionsIn(domain), VehicleId{5});
  link::VehicleLink listener(OptionsIn(domain));
  listener.Open(kListener);
  ReceptionMonitor monitor(listener);
  // Without a miss of the start, on a busy machine, which would take the place of that of the
  // pause.
  ASSERT_TRUE(Eventually([&] {
    monitor.Forget();
    Repeat(milliseconds(200), [&] {
      sender.Send();
      monitor.Listen();
    });
    return monitor.Heard().contains(VehicleId{5}) &&
           monitor.EventsOf(QosEventKind::kDeadlineMissed).empty() &&
           monitor.EventsOf(QosEventKind::kLivelinessLost).empty();
  }));
  monitor.Forget();
  // Ten deadlines go by: one edge, not ten misses.
  Repeat(milliseconds(1500), [&] { monitor.Listen(); });
  EXPECT_THAT(monitor.EventsOf(QosEventKind::kDeadlineMissed), SizeIs(1));
  EXPECT_THAT(monitor.EventsOf(QosEventKind::kLivelinessLost), SizeIs(1));
  EXPECT_TRUE(Eventually([&] {
    sender.Send();
    monitor.Listen();
    return !monitor.EventsOf(QosEventKind::kLivelinessBack).empty() && monitor.Heard().size() == 1;
  }));
  EXPECT_EQ(monitor.EventsOf(QosEventKind::kLivelinessBack).front(), VehicleId{5});
}

}  // namespace
}  // namespace giveway::test
