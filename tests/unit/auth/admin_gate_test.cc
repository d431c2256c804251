#include "services/auth/admin_gate.h"

#include <gmock/gmock.h>

#include <string>

#include "services/auth/seals.h"

namespace giveway::auth {
namespace {

using ::testing::HasSubstr;

constexpr const char* kKey = "0123456789abcdef";

AdminRequest Order(std::uint64_t number, const std::string& key = kKey) {
  AdminRequest order{.vehicle = VehicleId{7},
                     .number = number,
                     .kind = AdminRequestKind::kApply,
                     .profiles = {"a.xml", "<dds/>"}};
  order.seal = SealOf(key, order);
  return order;
}

TEST(AdminGate, IsShutUnlessToldOtherwise) {
  AdminGate shut;
  EXPECT_TRUE(shut.IsShut());
  EXPECT_THAT(shut.WhyNot(Order(1)), HasSubstr("takes no orders"));
  AdminGate open(true);
  EXPECT_FALSE(open.IsShut());
  EXPECT_EQ(open.WhyNot({}), "");
}

TEST(AdminGate, TakesAnOrderThatIsSealedWithItsKeyOnce) {
  AdminGate gate(kKey, 100);
  EXPECT_FALSE(gate.IsShut());
  EXPECT_EQ(gate.WhyNot(Order(101)), "");
  EXPECT_THAT(gate.WhyNot(Order(101)), HasSubstr("not above"));
  EXPECT_THAT(gate.WhyNot(Order(100)), HasSubstr("not above")) << "from before this process";
  EXPECT_EQ(gate.WhyNot(Order(300)), "");
  EXPECT_EQ(gate.WhyNot(Order(200)), "") << "from another, slower operator";
}

TEST(AdminGate, RefusesAnotherKeyNoSealAndAnyFieldThatWasChanged) {
  AdminGate gate(kKey, 0);
  EXPECT_THAT(gate.WhyNot(Order(1, "another key 12345")), HasSubstr("not sealed"));
  AdminRequest order = Order(1);
  order.seal = {};
  EXPECT_THAT(gate.WhyNot(order), HasSubstr("not sealed"));
  for (int i = 0; i < 5; ++i) {
    order = Order(1);
    if (i == 0) order.vehicle = VehicleId{8};
    if (i == 1) order.number = 2;
    if (i == 2) order.kind = AdminRequestKind::kKeepRing;
    if (i == 3) order.profiles.name = "b.xml";
    if (i == 4) order.profiles = {"a.xml<", "dds/>"};
    EXPECT_THAT(gate.WhyNot(order), HasSubstr("not sealed")) << i;
  }
  EXPECT_EQ(gate.WhyNot(Order(1)), "") << "a forgery uses up no number";
}

TEST(AdminGate, RemembersSoManyAndRefusesWhatIsOlder) {
  AdminGate gate(kKey, 0);
  for (std::uint64_t i = 1; i <= AdminGate::kMostRemembered + 10; ++i) {
    ASSERT_EQ(gate.WhyNot(Order(2 * i)), "");
  }
  EXPECT_THAT(gate.WhyNot(Order(2)), HasSubstr("not above"));
  EXPECT_THAT(gate.WhyNot(Order(3)), HasSubstr("not above")) << "new, but too old";
}

TEST(AdminGate, SealsAnAnswerWholly) {
  AdminGate gate(kKey, 0);
  AdminAnswer answer{.vehicle = VehicleId{7},
                     .order = 5,
                     .interface = "lo",
                     .profiles = {"a.xml", "<dds/>"},
                     .live = {{"fleet_beacon_reader", "deadline", 1}}};
  gate.Seal(&answer);
  EXPECT_TRUE(IsSealed(kKey, answer));
  AdminAnswer changed = answer;
  changed.live[0].number = 2;
  EXPECT_FALSE(IsSealed(kKey, changed));
  changed = answer;
  changed.order = 6;
  EXPECT_FALSE(IsSealed(kKey, changed));
  AdminAnswer unsealed = answer;
  unsealed.seal = {};
  AdminGate(true).Seal(&unsealed);
  EXPECT_EQ(unsealed.seal, Seal{});
}

}  // namespace
}  // namespace giveway::auth
