// What an impaired vehicle receives from others over real sockets. The model itself is tested in
// tests/unit/link/channel_model_test.cc; this tests that the transport follows it.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <thread>

#include "services/link/impairment/impairer.h"
#include "services/link/world_link.h"
#include "tests/link/fleet.h"
#include "tests/link/raw_vehicle.h"

namespace giveway::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr VehicleId kListener{1000};
constexpr VehicleId kThree{3};
constexpr VehicleId kFour{4};

link::LinkOptions ImpairedIn(const DomainLock& domain, std::vector<ImpairmentRule> rules) {
  link::LinkOptions options = OptionsIn(domain);
  options.impairment = {.seed = 7, .rules = std::move(rules)};
  return options;
}

// A vehicle that receives through `rules`, and the monitor of what it receives.
struct Listener {
  Listener(const DomainLock& domain, std::vector<ImpairmentRule> rules)
      : link(rules.empty() ? OptionsIn(domain) : ImpairedIn(domain, std::move(rules))),
        monitor(link) {
    link.Open(kListener);
  }
  ImpairmentCounters Impaired() const { return link.Impaired().value(); }

  link::VehicleLink link;
  ReceptionMonitor monitor;
};

TEST(Impaired, NobodyIsUnlessAsked) {
  const DomainLock domain;
  const Listener listener(domain, {});
  EXPECT_FALSE(listener.link.Impaired());
}

TEST(Impaired, ByTotalLossAVehicleHearsNothingWhileOthersHear) {
  const DomainLock domain;
  Listener all_lost(domain, {{.loss = 1}});
  Beaconing sender(OptionsIn(domain), kThree);
  Beaconing other(OptionsIn(domain), kFour);
  ReceptionMonitor others_monitor(other.Link());
  ASSERT_TRUE(Eventually([&] {
    sender.Send();
    others_monitor.Listen();
    all_lost.monitor.Listen();
    return others_monitor.Beacons().size() >= 50 && all_lost.Impaired().dropped_loss >= 5;
  }));
  EXPECT_TRUE(all_lost.monitor.Beacons().empty());
  EXPECT_EQ(all_lost.Impaired().passed, 0U);
  EXPECT_EQ(all_lost.link.Counters().matched_peers, 0U);
}

TEST(Impaired, ByAFifthLostHearsFourFifths) {
  constexpr std::uint32_t kSent = 2000;
  const DomainLock domain;
  Listener listener(domain, {{.from = ImpairedSender::kVehicles, .loss = 0.2}});
  Beaconing sender(OptionsIn(domain), kThree);
  ASSERT_TRUE(Eventually([&] {
    sender.Send();
    listener.monitor.Listen();
    return !listener.monitor.Heard().empty();
  }));
  Repeat(milliseconds(100), [&] { listener.monitor.Listen(); });
  listener.monitor.Forget();
  const std::uint32_t superseded_before = listener.link.Counters().beacons_superseded;
  for (std::uint32_t i = 0; i < kSent; ++i) {
    sender.Send();
    std::this_thread::sleep_for(milliseconds(2));
    listener.monitor.Listen();
  }
  Repeat(milliseconds(200), [&] { listener.monitor.Listen(); });
  // On a busy machine some were received and overwritten before they were taken.
  const std::uint32_t superseded = listener.link.Counters().beacons_superseded - superseded_before;
  const double received =
      static_cast<double>(listener.monitor.Beacons().size() + superseded) / kSent;
  // Five standard deviations, and 1 % for what the machine itself may lose.
  EXPECT_NEAR(received, 0.8, 5 * std::sqrt(0.2 * 0.8 / kSent) + 0.01);
  const ImpairmentCounters counters = listener.Impaired();
  EXPECT_EQ(counters.packets, counters.passed + counters.dropped_loss);
  // A gap is reported once, however wide: of 2000 with a fifth lost there are some 2000 * 0.2 *
  // 0.8.
  const auto gaps = listener.monitor.EventsOf(QosEventKind::kSampleLost);
  EXPECT_NEAR(static_cast<double>(gaps.size()), 320, 100 + superseded);
  EXPECT_THAT(gaps, ::testing::Each(kThree));
}

TEST(Impaired, ByADelayHearsNothingEarlier) {
  constexpr milliseconds kDelay(80);
  const DomainLock domain;
  Listener listener(domain, {{.from = ImpairedSender::kVehicles, .delay_s = 0.08}});
  Beaconing sender(OptionsIn(domain), kThree);
  std::vector<steady_clock::time_point> sent{steady_clock::now()};  // by sequence number
  std::vector<steady_clock::duration> took;
  ASSERT_TRUE(Eventually([&] {
    sent.push_back(steady_clock::now());
    sender.Send();
    listener.monitor.Forget();
    listener.monitor.Listen();
    const auto now = steady_clock::now();
    for (const ReceivedBeacon& received : listener.monitor.Beacons()) {
      took.push_back(now - sent[received.beacon.seq]);
    }
    return took.size() >= 100;
  }));
  EXPECT_GE(*std::ranges::min_element(took), kDelay);
  EXPECT_GE(listener.Impaired().delayed, 100U);
}

TEST(Impaired, SecondCopiesAndOvertakenOnesAreNotHeardByABestEffortReader) {
  const DomainLock domain;
  Listener listener(domain, {{.from = ImpairedSender::kVehicles,
                              .reorder = 0.2,
                              .reorder_by_s = 0.04,
                              .duplicate = 0.5}});
  Beaconing sender(OptionsIn(domain), kThree);
  ASSERT_TRUE(Eventually([&] {
    sender.Send();
    listener.monitor.Listen();
    return listener.monitor.Beacons().size() >= 200;
  }));
  std::uint32_t before = 0;
  for (const ReceivedBeacon& received : listener.monitor.Beacons()) {
    EXPECT_GT(received.beacon.seq, before);
    before = received.beacon.seq;
  }
  EXPECT_GT(before, listener.monitor.Beacons().size() + 10);  // the gaps
  EXPECT_GE(listener.Impaired().duplicated, 80U);
  EXPECT_GE(listener.Impaired().held_back, 20U);
  EXPECT_GE(listener.Impaired().reordered, 20U);
}

// One corrupted sequence number that the library accepts makes a best-effort reader permanently
// ignore the writer: hence one sender after the other.
TEST(Impaired, SpoiltBeaconsAreHeardAsSpoiltAndEverySoundOneIsTrue) {
  const DomainLock domain;
  Listener listener(domain, {{.from = ImpairedSender::kVehicles, .corrupt = 0.3}});
  std::size_t corrupted = 0;
  std::size_t sound = 0;
  for (int life = 0; life < 60 && (corrupted < 10 || sound < 50); ++life) {
    Beaconing sender(OptionsIn(domain), kThree);
    Repeat(milliseconds(400), [&] {
      sender.Send();
      listener.monitor.Forget();
      listener.monitor.Listen();
      for (const ReceivedBeacon& received : listener.monitor.Beacons()) {
        if (!received.crc_valid || !received.name_valid) {
          ++corrupted;
          continue;
        }
        ++sound;
        EXPECT_EQ(received.beacon.vehicle, kThree);
        EXPECT_EQ(Number(received.beacon.tick), received.beacon.seq);
      }
    });
  }
  EXPECT_GE(corrupted, 10U);
  EXPECT_GE(sound, 50U);
  EXPECT_GE(listener.Impaired().corrupted, corrupted);
}

// Discovery traffic too. Some are never found, as above; ghosts may appear; nothing crashes.
TEST(Impaired, SpoiltDiscoveryIsSurvived) {
  const DomainLock domain;
  Listener listener(domain, {{.duplicate = 0.2, .corrupt = 0.3}});
  int heard = 0;
  for (int life = 0; life < 20 && (heard < 3 || listener.Impaired().corrupted < 20); ++life) {
    Beaconing sender(OptionsIn(domain), kThree);
    listener.monitor.Forget();
    Repeat(milliseconds(500), [&] {
      sender.Send();
      listener.monitor.Listen();
    });
    heard += listener.monitor.Heard().contains(kThree) ? 1 : 0;
  }
  EXPECT_GE(heard, 3);
  EXPECT_GE(listener.Impaired().corrupted, 20U);
}

TEST(Impaired, FromOneVehicleOnlyHearsTheOthers) {
  const DomainLock domain;
  Listener listener(domain, {{.from = ImpairedSender::kOneVehicle,
                              .from_vehicle = kThree,
                              .to_vehicle = kListener,
                              .loss = 1}});
  Listener spared(domain, {{.from = ImpairedSender::kOneVehicle,
                            .from_vehicle = kThree,
                            .to_vehicle = VehicleId{77},
                            .loss = 1}});
  Beaconing three(OptionsIn(domain), kThree);
  Beaconing four(OptionsIn(domain), kFour);
  ASSERT_TRUE(Eventually([&] {
    three.Send();
    four.Send();
    listener.monitor.Listen();
    spared.monitor.Listen();
    // Dropped senders are known by name once discovery has announced them: how many are before
    // varies.
    return listener.monitor.Beacons().size() >= 50 && listener.Impaired().dropped_loss >= 20 &&
           spared.monitor.Heard().contains(kThree);
  }));
  EXPECT_THAT(listener.monitor.Heard(), ::testing::ElementsAre(kFour));
  EXPECT_EQ(spared.Impaired().Dropped(), 0U);
}

// The world reports that the run has started; from then on time counts.
void StartRun(link::WorldLink* world, Listener* listener) {
  const SessionId session{1, 2, 3, 4};
  listener->link.SendJoin({session, kListener});
  RosterEntry entry{.session = session, .vehicle = kListener, .accepted = true};
  entry.epoch = WorldEpoch{1};
  entry.run_state = RunState::kRunning;
  world->SendRoster(entry);
}

TEST(Impaired, InABlackoutAfterTheStartHearsNothingAndThenAgain) {
  const DomainLock domain;
  ImpairmentRule rule{.from = ImpairedSender::kVehicles};
  rule.blackouts = {{0, 3}};
  Listener listener(domain, {rule});
  Beaconing sender(OptionsIn(domain), kThree);
  link::WorldLink world(OptionsIn(domain));
  const auto turn = [&] {
    sender.Send();
    listener.monitor.Listen();
  };
  ASSERT_TRUE(Eventually([&] {
    turn();
    return listener.monitor.Beacons().size() >= 10;
  }));
  EXPECT_EQ(listener.Impaired().dropped_blackout, 0U);

  StartRun(&world, &listener);
  ASSERT_TRUE(Eventually([&] {
    turn();
    return listener.Impaired().dropped_blackout > 0;
  }));
  listener.monitor.Forget();
  Repeat(milliseconds(300), turn);
  EXPECT_TRUE(listener.monitor.Heard().empty());
  EXPECT_TRUE(Eventually([&] {
    turn();
    return listener.monitor.Heard().contains(kThree);
  }));
}

// As a blackout, by a rule that holds for a time.
TEST(Impaired, ByARuleThatHoldsForATimeHearsNothingThenAndAgainAfterIt) {
  const DomainLock domain;
  ImpairmentRule rule{.from = ImpairedSender::kVehicles, .loss = 1};
  rule.from_s = 0;
  rule.to_s = 3;
  Listener listener(domain, {rule});
  Beaconing sender(OptionsIn(domain), kThree);
  link::WorldLink world(OptionsIn(domain));
  const auto turn = [&] {
    sender.Send();
    listener.monitor.Listen();
  };
  ASSERT_TRUE(Eventually([&] {
    turn();
    return listener.monitor.Beacons().size() >= 10;
  }));
  EXPECT_EQ(listener.Impaired().dropped_loss, 0U);
  StartRun(&world, &listener);
  ASSERT_TRUE(Eventually([&] {
    turn();
    return listener.Impaired().dropped_loss > 0;
  }));
  listener.monitor.Forget();
  Repeat(milliseconds(300), turn);
  EXPECT_TRUE(listener.monitor.Heard().empty());
  EXPECT_TRUE(Eventually([&] {
    turn();
    return listener.monitor.Heard().contains(kThree);
  }));
  EXPECT_EQ(listener.Impaired().Dropped(), listener.Impaired().dropped_loss);
}

TEST(Impaired, ClosingDoesNotWaitForWhatIsUnderWay) {
  const DomainLock domain;
  std::optional<Listener> listener;
  listener.emplace(domain, std::vector<ImpairmentRule>{{.delay_s = 10}});
  Beaconing sender(OptionsIn(domain), kThree);
  ASSERT_TRUE(Eventually([&] {
    sender.Send();
    return listener->Impaired().delayed > 3;
  }));
  const auto before = steady_clock::now();
  listener.reset();
  EXPECT_LT(steady_clock::now() - before, std::chrono::seconds(5));
}

}  // namespace
}  // namespace giveway::test
