// Orders and answers over the wire, and a deadline that is changed while the endpoint runs.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>

#include "services/link/observer_link.h"
#include "services/link/operator_link.h"
#include "services/link/world_link.h"
#include "tests/link/fleet.h"

namespace giveway::test {
namespace {

using std::chrono::milliseconds;

AdminRequest OrderTo(VehicleId vehicle, std::uint64_t number) {
  return {.vehicle = vehicle,
          .number = number,
          .kind = AdminRequestKind::kApply,
          .profiles = {"mine.xml", "<dds>" + std::string(40'000, ' ') + "</dds>"}};
}

// What has come once anything has.
std::vector<AdminRequest> OrdersOf(Beaconing& vehicle) {
  std::vector<AdminRequest> orders;
  EXPECT_TRUE(Eventually([&] {
    orders = vehicle.Link().TakeAdminRequests();
    return !orders.empty();
  }));
  return orders;
}

TEST(Admin, AnOrderReachesItsVehicleAloneAndWhole) {
  const DomainLock domain;
  Beaconing one(OptionsIn(domain), VehicleId{1});
  Beaconing two(OptionsIn(domain), VehicleId{2});
  link::OperatorLink chief(OptionsIn(domain));
  chief.Seek(VehicleId{1});
  chief.Seek(VehicleId{2});
  ASSERT_TRUE(
      Eventually([&] { return chief.Reaches(VehicleId{1}) && chief.Reaches(VehicleId{2}); }));
  const AdminRequest sent = OrderTo(VehicleId{2}, 77);
  ASSERT_TRUE(chief.Send(sent));
  const auto got = OrdersOf(two);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].number, 77U);
  EXPECT_EQ(got[0].kind, AdminRequestKind::kApply);
  EXPECT_EQ(got[0].profiles, sent.profiles);
  // What it is sent next is the first that the other hears.
  ASSERT_TRUE(chief.Send(OrderTo(VehicleId{1}, 78)));
  EXPECT_EQ(OrdersOf(one).at(0).number, 78U);
}

// It goes in fragments, which the packet filter puts together.
TEST(Admin, AnAnswerLargerThanADatagramReachesItsOperatorWhole) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  link::OperatorLink chief(OptionsIn(domain));
  chief.Seek(kNoVehicle);
  ASSERT_TRUE(Eventually([&] { return chief.Reaches(kNoVehicle); }));
  AdminAnswer sent{.vehicle = kNoVehicle, .profiles = {"large.xml", std::string(59'000, 'x')}};
  for (std::int64_t i = 0; i < 1000; ++i) {
    sent.live.push_back({"fleet_beacon_writer", "history_depth", i});
  }
  for (std::uint64_t order = 1; order <= 5; ++order) {
    sent.order = order;
    world.SendAnswer(sent);
    std::vector<AdminAnswer> answers;
    ASSERT_TRUE(Eventually([&] {
      answers = chief.Take();
      return !answers.empty();
    })) << order;
    EXPECT_EQ(answers[0].order, order);
    EXPECT_EQ(answers[0].profiles, sent.profiles);
    EXPECT_EQ(answers[0].live, sent.live);
  }
}

TEST(Admin, AnOrderToTheWorldReachesItAndIsAnswered) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  Beaconing vehicle(OptionsIn(domain), VehicleId{1});
  link::OperatorLink chief(OptionsIn(domain));
  chief.Seek(kNoVehicle);
  ASSERT_TRUE(Eventually([&] { return chief.Reaches(kNoVehicle); }));
  ASSERT_TRUE(chief.Send(OrderTo(kNoVehicle, 9)));
  std::vector<AdminRequest> orders;
  ASSERT_TRUE(Eventually([&] {
    orders = world.TakeAdminRequests();
    return !orders.empty();
  }));
  EXPECT_EQ(orders[0].number, 9U);
  world.SendAnswer({.vehicle = kNoVehicle, .order = 9, .profiles = {"mine.xml", "<dds/>"}});
  std::vector<AdminAnswer> answers;
  ASSERT_TRUE(Eventually([&] {
    answers = chief.Take();
    return !answers.empty();
  }));
  EXPECT_EQ(answers[0].vehicle, kNoVehicle);
  EXPECT_EQ(answers[0].order, 9U);
  EXPECT_TRUE(Eventually([&] { return chief.Announced() == std::vector{VehicleId{1}}; }));
}

TEST(Admin, AnOrderIsNotKeptForAVehicleThatComesLater) {
  const DomainLock domain;
  link::OperatorLink chief(OptionsIn(domain));
  chief.Seek(VehicleId{1});
  {
    Beaconing before(OptionsIn(domain), VehicleId{1});
    ASSERT_TRUE(Eventually([&] { return chief.Reaches(VehicleId{1}); }));
    ASSERT_TRUE(chief.Send(OrderTo(VehicleId{1}, 1)));
    ASSERT_EQ(OrdersOf(before).size(), 1U);
  }
  ASSERT_TRUE(Eventually([&] { return !chief.Reaches(VehicleId{1}); }));
  Beaconing again(OptionsIn(domain), VehicleId{1});
  ASSERT_TRUE(Eventually([&] { return chief.Reaches(VehicleId{1}); }));
  ASSERT_TRUE(chief.Send(OrderTo(VehicleId{1}, 2)));
  const auto got = OrdersOf(again);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].number, 2U);
}

TEST(Admin, AnAnswerTellsWhatTheEndpointsRunWith) {
  const DomainLock domain;
  Beaconing vehicle(OptionsIn(domain), VehicleId{3});
  link::OperatorLink chief(OptionsIn(domain));
  vehicle.Link().SendAnswer({.vehicle = VehicleId{3},
                             .order = 5,
                             .state = AnswerState::kInEffect,
                             .fleet_size = 2,
                             .interface = "127.0.0.1",
                             .profiles = {"mine.xml", "<dds/>"},
                             .live = vehicle.Link().LiveQos()});
  std::vector<AdminAnswer> got;  // kept for late joiners
  ASSERT_TRUE(Eventually([&] {
    got = chief.Take();
    return !got.empty();
  }));
  EXPECT_EQ(got[0].order, 5U);
  EXPECT_EQ(got[0].profiles.name, "mine.xml");
  const LiveValue deadline{"fleet_beacon_reader", "deadline", 150'000'000};
  EXPECT_THAT(got[0].live, ::testing::Contains(deadline));
}

TEST(Admin, SeveralOperatorsWhoAskAtOnceEachGetTheAnswerToTheirOrder) {
  const DomainLock domain;
  Beaconing vehicle(OptionsIn(domain), VehicleId{3});
  link::OperatorLink chief(OptionsIn(domain));
  std::vector<std::uint64_t> got;
  const auto has_come = [&](std::uint64_t order) {
    return Eventually([&] {
      for (const AdminAnswer& answer : chief.Take()) got.push_back(answer.order);
      return std::ranges::find(got, order) != got.end();
    });
  };
  const auto answer = [&](std::uint64_t order) {
    vehicle.Link().SendAnswer({.vehicle = VehicleId{3}, .order = order, .profiles = {"x", "x"}});
  };
  answer(1);
  ASSERT_TRUE(has_come(1));
  // Each operator receives the answers to all, even if several come between two calls of Take.
  for (const std::uint64_t order : {2U, 3U, 4U, 5U}) answer(order);
  EXPECT_TRUE(has_come(5));
  EXPECT_THAT(got, ::testing::ElementsAre(1, 2, 3, 4, 5));
}

TEST(Admin, ADeadlineThatWasChangedIsTheOneThatHolds) {
  const DomainLock domain;
  constexpr milliseconds kLonger(600);
  Beaconing sender(OptionsIn(domain), VehicleId{1});
  Beaconing hearer(OptionsIn(domain), VehicleId{2});
  ASSERT_TRUE(hearer.Link().SetDeadline("fleet_beacon_reader", Nanoseconds(kLonger).count()));
  EXPECT_EQ(hearer.Link().BeaconQos().deadline_requested_ms, 600);
  ReceptionMonitor monitor(hearer.Link());
  std::chrono::steady_clock::time_point silent_since;
  ASSERT_TRUE(Eventually([&] {
    silent_since = std::chrono::steady_clock::now();
    sender.Send();
    monitor.Listen();
    return monitor.Heard().contains(VehicleId{1});
  }));
  ASSERT_TRUE(Eventually([&] {
    monitor.Listen();
    const auto missed = monitor.EventsOf(QosEventKind::kDeadlineMissed);
    return std::ranges::find(missed, VehicleId{1}) != missed.end();
  }));
  // The last sample came a moment before.
  EXPECT_GE(std::chrono::steady_clock::now() - silent_since, kLonger - milliseconds(100));
}

// `qos apply` may lengthen what the vehicles agree on: who only observes loses none of them by
// that.
TEST(Admin, AnObserverHearsAVehicleWhateverDeadlineItOffers) {
  const DomainLock domain;
  Beaconing sender(OptionsIn(domain), VehicleId{1});
  ASSERT_TRUE(
      sender.Link().SetDeadline("fleet_beacon_writer", Nanoseconds(milliseconds(2000)).count()));
  link::ObserverLink observer(OptionsIn(domain));
  EXPECT_TRUE(Eventually([&] {
    sender.Send();
    return !observer.Take().beacons.empty();
  }));
}

// One profile with the same values a hundred times: the answer would not fit on the wire.
TEST(Admin, AWorldListsTheWritersOfItsVehiclesOnce) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  world.OpenRanges(VehicleId{1});
  const std::vector<LiveValue> of_one = world.LiveQos();
  for (std::uint32_t id = 2; id <= 100; ++id) world.OpenRanges(VehicleId{id});
  EXPECT_EQ(world.LiveQos(), of_one);
  constexpr std::int64_t kOther = 77'000'000;
  ASSERT_TRUE(world.SetDeadline("world_ranges_writer", kOther));
  EXPECT_THAT(world.LiveQos(),
              ::testing::Contains(LiveValue{"world_ranges_writer", "deadline", kOther}));
}

// A vehicle that joined after an order had changed the deadlines of its ranges never matched.
TEST(Admin, ADeadlineThatWasChangedIsThatOfEndpointsMadeLaterToo) {
  const DomainLock domain;
  constexpr std::int64_t kShorter = Nanoseconds(milliseconds(40)).count();
  link::WorldLink world(OptionsIn(domain));
  ASSERT_TRUE(world.SetDeadline("world_ranges_writer", kShorter));
  link::VehicleLink vehicle(OptionsIn(domain));
  ASSERT_TRUE(vehicle.SetDeadline("world_ranges_reader", kShorter));
  world.OpenRanges(VehicleId{1});
  vehicle.Open(VehicleId{1});
  EXPECT_THAT(world.LiveQos(),
              ::testing::Contains(LiveValue{"world_ranges_writer", "deadline", kShorter}));
  EXPECT_THAT(vehicle.LiveQos(),
              ::testing::Contains(LiveValue{"world_ranges_reader", "deadline", kShorter}));
  EXPECT_TRUE(Eventually([&] { return world.IsMatched(VehicleId{1}); }));
}

}  // namespace
}  // namespace giveway::test
