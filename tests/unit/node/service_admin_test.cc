// What a service answers to orders, by a link that only keeps them.
#include "services/node/service_admin.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "services/auth/seals.h"

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

AdminAnswer AnswerOf(KeepingLink* link, const link::LinkOptions& options, AdminRequestKind kind) {
  ServiceAdmin admin(link, options, kVehicle, false, auth::AdminGate(kKey, 0));
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

}  // namespace
}  // namespace giveway
