// What a service answers to orders, by a link that only keeps them.
#include "services/node/service_admin.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "services/auth/seals.h"
#include "services/runtime/restart.h"
#include "tests/support/no_descriptors.h"

namespace giveway {
namespace {

constexpr const char* kKey = "0123456789abcdef";
constexpr VehicleId kVehicle{7};

// Keeps what an operator would receive.
class KeepingLink final : public link::AdminLink {
 public:
  explicit KeepingLink(std::vector<LiveValue> live) : live_(std::move(live)) {}
  void Give(const AdminRequest& order) { orders_.push_back(order); }
  const AdminAnswer& Received() const { return received_; }

  std::vector<AdminRequest> TakeAdminRequests() override { return std::exchange(orders_, {}); }
  void SendAnswer(const AdminAnswer& answer) override { received_ = link::AsReceived(answer); }
  std::vector<LiveValue> LiveQos() const override { return live_; }
  bool SetDeadline(const std::string&, std::int64_t) override { return true; }

 private:
  std::vector<LiveValue> live_;
  std::vector<AdminRequest> orders_;
  AdminAnswer received_;
};

AdminRequest SealedOrder(AdminRequestKind kind) {
  AdminRequest order{.vehicle = kVehicle, .number = 1, .kind = kind, .profiles = {}};
  order.seal = auth::SealOf(kKey, order);
  return order;
}

std::string Default() {
  std::ifstream file(GIVEWAY_QOS_SETS "/default.xml", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The set with every deadline of one length replaced.
std::string WithDeadline(std::string set, const std::string& from_ns, const std::string& to_ns) {
  for (std::size_t at = 0; (at = set.find("<nanosec>" + from_ns + '<', at)) != std::string::npos;) {
    set.replace(at + 9, from_ns.size(), to_ns);
  }
  return set;
}

// What a service of such a fleet, which runs with `in_use`, answers to an order of `wanted`.
AdminAnswer AnswerToOrder(const qos::Deployment& deployment, const std::string& in_use,
                          const std::string& wanted) {
  KeepingLink link({});
  link::LinkOptions options;
  options.qos = {"in_use.xml", in_use};
  ServiceAdmin admin(&link, options, deployment, kVehicle, false, auth::AdminGate(kKey, 0));
  AdminRequest order{.vehicle = kVehicle,
                     .number = 1,
                     .kind = AdminRequestKind::kApply,
                     .profiles = {"wanted.xml", wanted}};
  order.seal = auth::SealOf(kKey, order);
  link.Give(order);
  EXPECT_FALSE(admin.Serve());
  return link.Received();
}

AdminAnswer AnswerOf(KeepingLink* link, const link::LinkOptions& options, AdminRequestKind kind) {
  ServiceAdmin admin(link, options, {}, kVehicle, false, auth::AdminGate(kKey, 0));
  link->Give(SealedOrder(kind));
  EXPECT_FALSE(admin.Serve());
  return link->Received();
}

// Of a world of a hundred vehicles: operators took its answers for those of another key.
TEST(ServiceAdmin, SealsOfAnAnswerTooLongForTheWireWhatIsSent) {
  std::vector<LiveValue> live;
  for (int i = 0; i < 5000; ++i) live.push_back({"world_ranges_writer", "deadline", i});
  KeepingLink link(live);
  const AdminAnswer answer = AnswerOf(&link, {}, AdminRequestKind::kReportQos);
  EXPECT_LT(answer.live.size(), live.size());
  EXPECT_GT(answer.live.size(), 1000U);
  EXPECT_TRUE(auth::IsSealed(kKey, answer));
}

TEST(ServiceAdmin, SealsOfTextTooLongForTheWireWhatIsSent) {
  link::LinkOptions options;
  options.interface = std::string(300, 'x');
  options.qos.name = std::string(300, 'y');
  KeepingLink link({});
  EXPECT_TRUE(auth::IsSealed(kKey, AnswerOf(&link, options, AdminRequestKind::kReportQos)));
  EXPECT_TRUE(auth::IsSealed(kKey, AnswerOf(&link, options, AdminRequestKind::kKeepRing)));
}

// Orders were held against a fleet of 20 Hz whatever its tick: one of 50 Hz refused the set it ran
// with, one of 10 Hz took deadlines that every sample missed.
TEST(ServiceAdmin, HoldsOrdersAgainstTheTickOfItsFleet) {
  const std::string fast =
      WithDeadline(WithDeadline(Default(), "100000000", "40000000"), "150000000", "60000000");
  const qos::Deployment at_50_hz{.vehicles = 2, .vehicles_a_host = 1, .tick_ns = 20'000'000};
  const AdminAnswer taken = AnswerToOrder(at_50_hz, Default(), fast);
  EXPECT_EQ(taken.state, AnswerState::kInEffect) << taken.reason;
  const qos::Deployment at_20_hz{.vehicles = 2, .vehicles_a_host = 1};
  const AdminAnswer refused = AnswerToOrder(at_20_hz, Default(), fast);
  EXPECT_EQ(refused.state, AnswerState::kRefused);
  EXPECT_THAT(refused.reason, testing::HasSubstr("deadline_too_short"));
}
TEST(ServiceAdmin, HoldsOrdersAgainstTheParticipantsOfOneHostAtAStart) {
  const qos::Deployment of_500{.vehicles = 500, .vehicles_a_host = 1};
  const std::string longer = WithDeadline(Default(), "150000000", "160000000");
  const AdminAnswer answer = AnswerToOrder(of_500, Default(), longer);
  EXPECT_EQ(answer.state, AnswerState::kInEffect) << answer.reason;
}

// Regression: without a descriptor left a service that was to restart itself ended.
TEST(ServiceAdmin, ComesBackWithWhatItsCommandLineSaysWhereItCanHoldNothing) {
  if (!test::NoDescriptors::kErrorsCanBeThrown) GTEST_SKIP() << "the sanitizer needs descriptors";
  KeepingLink link({});
  link::LinkOptions options;
  options.qos = {HoldText("earlier.xml", Default()), Default()};
  LetGo(options.qos.name);
  const ServiceAdmin admin(&link, options, {}, kVehicle, false, auth::AdminGate(kKey, 0));
  NewFlags flags;
  {
    const test::NoDescriptors none;
    flags = admin.ToComeBack();
  }
  EXPECT_EQ(flags, (NewFlags{{"--former-qos", ""}, {"--rolled-back", ""}}));
  const std::string& held = options.qos.name;
  const int descriptor = std::stoi(held.substr(held.rfind('/') + 1));
  EXPECT_EQ(fcntl(descriptor, F_GETFD) & FD_CLOEXEC, 0) << "closed to the next process image";
  close(descriptor);
}

}  // namespace
}  // namespace giveway
