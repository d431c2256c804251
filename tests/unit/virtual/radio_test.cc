// The virtual fleet's radio: which vehicle receives what and when, by statistics where it draws.
#include "sim_world/virtual/radio.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "tests/support/brain_bench.h"

namespace giveway::sim {
namespace {

constexpr std::size_t kListener = 0;
constexpr std::size_t kTalker = 1;

Scenario TwoVehicles(Nanoseconds tick_period) {
  Scenario scenario;
  scenario.tick_period = tick_period;
  scenario.vehicles.resize(2);
  scenario.vehicles[kListener].id = VehicleId{1};
  scenario.vehicles[kTalker].id = VehicleId{2};
  return scenario;
}

// Vehicle 2 talks every tick, vehicle 1 listens.
class RadioTest : public testing::Test {
 protected:
  explicit RadioTest() { places_ = {{{0, 0}, true}, {{3, 0}, true}}; }

  void Begin(const RadioSettings& settings, std::uint64_t seed = 1) {
    radio_.emplace(TwoVehicles(tick_period_), settings, seed);
    tick_ = 0;
  }
  // One tick: sequence numbers heard in it.
  std::vector<std::uint32_t> Tick() {
    ++tick_;
    radio_->BeginTick(giveway::Tick{tick_}, 0.05 * tick_, places_);
    heard_.clear();
    events_.clear();
    radio_->Hear(kListener, &heard_);
    radio_->Notice(kListener, &events_);
    if (talks_) {
      Beacon beacon;
      beacon.vehicle = VehicleId{2};
      beacon.boot_epoch = 7;
      beacon.seq = tick_;
      beacon.world_from_body.position_world = places_[kTalker].position_world;
      radio_->Transmit(kTalker, giveway::Tick{tick_}, beacon);
    }
    std::vector<std::uint32_t> numbers;
    for (const ReceivedBeacon& received : heard_) numbers.push_back(received.beacon.seq);
    return numbers;
  }
  // All sequence numbers heard in so many ticks, in the order they were heard.
  std::vector<std::uint32_t> Ticks(std::uint32_t count) {
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::vector<std::uint32_t> numbers = Tick();
      all.insert(all.end(), numbers.begin(), numbers.end());
    }
    return all;
  }

  // What the middleware said in each of so many ticks of silence, by kind.
  std::vector<std::pair<std::uint32_t, QosEventKind>> SaidOfSilence() {
    Begin({});
    talks_ = true;
    Ticks(10);
    talks_ = false;
    Tick();  // hears the last one
    std::vector<std::pair<std::uint32_t, QosEventKind>> said;
    for (std::uint32_t silent = 1; silent <= 20; ++silent) {
      Tick();
      for (const QosEvent& event : events_) {
        EXPECT_EQ(event.vehicle, VehicleId{2});
        said.emplace_back(silent, event.kind);
      }
    }
    return said;
  }

  Nanoseconds tick_period_{50'000'000};
  std::optional<Radio> radio_;
  std::vector<RadioPlace> places_;
  std::vector<ReceivedBeacon> heard_;
  std::vector<QosEvent> events_;
  std::uint32_t tick_ = 0;
  bool talks_ = true;
};

using Numbers = std::vector<std::uint32_t>;

TEST_F(RadioTest, EveryBeaconIsHeardATickAfterItWasSaidAndNotBefore) {
  Begin({});
  EXPECT_EQ(Tick(), Numbers{});
  for (std::uint32_t seq = 1; seq <= 5; ++seq) EXPECT_EQ(Tick(), Numbers{seq});
  EXPECT_EQ(heard_[0].received, tick_ * Nanoseconds(50'000'000));
  EXPECT_TRUE(heard_[0].crc_valid && heard_[0].name_valid);
  EXPECT_EQ(heard_[0].writer, 7U);
}

TEST_F(RadioTest, LooksOnceForAllWhoHearWhetherABeaconIsInRange) {
  Begin({});
  talks_ = false;
  for (const double speed_rad_s : {3.0, 31.0}) {
    Tick();
    Beacon beacon = test::BeaconOf(2, tick_, {{3, 0}, 0});
    beacon.wheels.left_rad_s = speed_rad_s;
    radio_->Transmit(kTalker, giveway::Tick{tick_}, beacon);
    Tick();
    ASSERT_EQ(heard_.size(), 1U);
    EXPECT_EQ(heard_[0].in_range, speed_rad_s < 30);
  }
}

TEST_F(RadioTest, WhoTalksHearsItselfOnlyWhereTheRadioLoopsBack) {
  for (const bool loops_back : {false, true}) {
    Begin({.loops_back = loops_back});
    Ticks(3);
    heard_.clear();
    radio_->Hear(kTalker, &heard_);
    EXPECT_EQ(heard_.size(), loops_back ? 1U : 0U);
  }
}

TEST_F(RadioTest, LosesTheShareItIsToldTo) {
  Begin({.loss = 0.2});
  constexpr std::uint32_t kTicks = 40'000;
  const double heard = static_cast<double>(Ticks(kTicks).size()) / kTicks;
  EXPECT_NEAR(heard, 0.8, 0.01);  // five standard deviations
}

TEST_F(RadioTest, SeedsDrawDifferentLossesAndTheSameSeedTheSame) {
  Begin({.loss = 0.5}, 1);
  const Numbers first = Ticks(200);
  Begin({.loss = 0.5}, 2);
  EXPECT_NE(Ticks(200), first);
  Begin({.loss = 0.5}, 1);
  EXPECT_EQ(Ticks(200), first);
}

TEST_F(RadioTest, BurstsHaveTheShareAndTheLengthOfTheirChain) {
  // Bad for a share of 0.02 / (0.02 + 0.1) = 1/6 of the time, ten ticks at a time.
  Begin({.burst = {.enter = 0.02, .leave = 0.1, .loss = 1}});
  std::uint32_t lost = 0;
  std::uint32_t bursts = 0;
  bool heard_before = true;
  Tick();
  constexpr std::uint32_t kTicks = 200'000;
  for (std::uint32_t i = 0; i < kTicks; ++i) {
    const bool heard = !Tick().empty();
    lost += heard ? 0 : 1;
    bursts += heard_before && !heard ? 1 : 0;
    heard_before = heard;
  }
  EXPECT_NEAR(static_cast<double>(lost) / kTicks, 1.0 / 6, 0.015);
  EXPECT_NEAR(static_cast<double>(lost) / bursts, 10, 0.7);
}

TEST_F(RadioTest, ABurstGoesOnWhileNobodyListens) {
  // Links never change their mind again once they are bad; after ten ticks out of reach this one
  // must still be bad, and in the stationary share of seeds it is.
  int bad = 0;
  constexpr int kSeeds = 4000;
  for (int seed = 0; seed < kSeeds; ++seed) {
    Begin({.burst = {.enter = 0.05, .leave = 0.15, .loss = 1}}, static_cast<std::uint64_t>(seed));
    Ticks(3);
    places_[kTalker].position_world.x = 100;
    Ticks(10);
    places_[kTalker].position_world.x = 3;
    bad += Tick().empty() ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(bad) / kSeeds, 0.25, 0.035);
}

TEST_F(RadioTest, ADelayIsRoundedUpToTheNextTick) {
  Begin({.delay = Nanoseconds(120'000'000)});
  EXPECT_EQ(Ticks(3), Numbers{});
  EXPECT_EQ(Tick(), Numbers{1});
  EXPECT_EQ(Tick(), Numbers{2});
}

TEST_F(RadioTest, JitterSpreadsArrivalsEvenlyOverItsTicksAndLosesNone) {
  Begin({.delay = Nanoseconds(50'000'000), .jitter = Nanoseconds(100'000'000)});
  constexpr std::uint32_t kTicks = 30'000;
  std::array<std::uint32_t, 6> after{};
  for (std::uint32_t i = 0; i < kTicks; ++i) {
    for (const std::uint32_t seq : Tick()) ++after.at(tick_ - seq);
  }
  EXPECT_EQ(after[0] + after[1] + after[4] + after[5], 0U);
  EXPECT_NEAR(after[2], kTicks / 2.0, 500);
  EXPECT_NEAR(after[3], kTicks / 2.0, 500);
}

TEST_F(RadioTest, OrderIsKeptUnlessItIsToldToReorder) {
  Begin({.loss = 0.3, .delay = Nanoseconds(80'000'000)});
  EXPECT_TRUE(std::ranges::is_sorted(Ticks(500)));
  Begin({.reorder = 0.1});
  const Numbers heard = Ticks(5000);
  EXPECT_FALSE(std::ranges::is_sorted(heard));
  // Held back for two ticks: overtaken by two, and nothing is lost.
  EXPECT_GE(heard.size(), 4996U);
  const auto late = std::ranges::count_if(heard, [&, newest = 0U](std::uint32_t seq) mutable {
    const bool overtaken = seq < newest;
    newest = std::max(newest, seq);
    return overtaken;
  });
  EXPECT_NEAR(static_cast<double>(late), 5000 * 0.1, 110);
}

TEST_F(RadioTest, DuplicatesComeATickLater) {
  Begin({.duplicate = 0.25});
  constexpr std::uint32_t kTicks = 20'000;
  const Numbers heard = Ticks(kTicks);
  EXPECT_NEAR(static_cast<double>(heard.size()), kTicks * 1.25, kTicks * 0.02);
  const std::set<std::uint32_t> different(heard.begin(), heard.end());
  EXPECT_EQ(different.size(), kTicks - 1);
}

TEST_F(RadioTest, NothingPassesABlackout) {
  Begin({.blackouts = {{.vehicle = VehicleId{2}, .from_s = 0.5, .to_s = 1.0}}});
  const Numbers heard = Ticks(40);
  // Heard at 0.5 s would be what was said at tick 9; at 1.0 s what was said at tick 19.
  for (std::uint32_t seq = 9; seq < 19; ++seq) {
    EXPECT_EQ(std::ranges::count(heard, seq), 0) << seq;
  }
  EXPECT_EQ(heard.size(), 39U - 10U);
}

TEST_F(RadioTest, WhoDrivesOutOfTheRadiusIsHeardUntilOneBeaconSaysSo) {
  Begin({});
  const auto heard_at = [&](double distance_m) {
    places_[kTalker].position_world = {distance_m, 0};
    Tick();  // what was said at the place before
    return Ticks(5).size();
  };
  EXPECT_EQ(heard_at(5.4), 5U);  // 5 m of emission radius: not so far that a brain must believe it
  EXPECT_EQ(heard_at(5.6), 1U);
  EXPECT_EQ(heard_at(5.4), 0U);
  EXPECT_EQ(heard_at(4.9), 5U);
  EXPECT_EQ(heard_at(6.6), 0U);
}

TEST_F(RadioTest, AReachOfItsOwnEndsWhereItEnds) {
  Begin({.reach_m = 2.0});
  places_[kTalker].position_world = {0, 1.99};
  EXPECT_EQ(Ticks(3).size(), 2U);
  places_[kTalker].position_world = {0, 2.01};
  EXPECT_EQ(Ticks(3), Numbers{});
}

TEST_F(RadioTest, ASilentPeerMissesItsDeadlineOnceAndThenItsLease) {
  const std::vector<std::pair<std::uint32_t, QosEventKind>> expected = {
      {3, QosEventKind::kDeadlineMissed}, {5, QosEventKind::kLivelinessLost}};
  EXPECT_EQ(SaidOfSilence(), expected);
}

// Regression: with ticks of 200 ms one beacon that was lost was a missed deadline, two a lost peer.
TEST_F(RadioTest, LongerTicksGiveAPeerAsManyBeaconsToLose) {
  tick_period_ = Nanoseconds{200'000'000};
  const std::vector<std::pair<std::uint32_t, QosEventKind>> expected = {
      {3, QosEventKind::kDeadlineMissed}, {5, QosEventKind::kLivelinessLost}};
  EXPECT_EQ(SaidOfSilence(), expected);
  tick_period_ = Nanoseconds{10'000'000};
  ASSERT_EQ(SaidOfSilence().size(), 1U);  // in 20 of these ticks the lease is not over
  EXPECT_EQ(SaidOfSilence().front().first, 15U);
}

TEST_F(RadioTest, WhoDrivesOutOfReachIsNotMissed) {
  Begin({});
  Ticks(10);
  places_[kTalker].position_world = {20, 0};
  for (int i = 0; i < 20; ++i) {
    Tick();
    EXPECT_TRUE(events_.empty());
  }
}

TEST_F(RadioTest, WhoIsHeardAgainCanBeMissedAgain) {
  Begin({});
  std::uint32_t misses = 0;
  for (int round = 0; round < 3; ++round) {
    talks_ = true;
    Ticks(5);
    talks_ = false;
    for (int i = 0; i < 10; ++i) {
      Tick();
      misses += static_cast<std::uint32_t>(
          std::ranges::count(events_, QosEventKind::kDeadlineMissed, &QosEvent::kind));
    }
  }
  EXPECT_EQ(misses, 3U);
}

}  // namespace
}  // namespace giveway::sim
