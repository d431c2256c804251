// Which orders a service takes, by its flags.
#include "services/node/admin_access.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "services/auth/seals.h"

namespace giveway {
namespace {

constexpr const char* kAccessKey = "0123456789abcdef";
constexpr std::uint64_t kHour_ns = 3'600'000'000'000;

class AdminAccess : public ::testing::Test {
 protected:
  AdminAccess() {
    std::ofstream(key_) << kAccessKey;
    flags_.admin_key = key_;
  }
  ~AdminAccess() override { std::filesystem::remove(key_); }

  // By a new process with these flags.
  std::string WhyNot(std::uint64_t number) const {
    AdminRequest order{.vehicle = VehicleId{7},
                       .number = number,
                       .kind = AdminRequestKind::kApply,
                       .profiles = {}};
    order.seal = auth::SealOf(kAccessKey, order);
    return AdminGateOf(flags_).WhyNot(order);
  }
  static std::uint64_t Now_ns() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(std::chrono::nanoseconds(now).count());
  }

  const std::filesystem::path key_ =
      std::filesystem::temp_directory_path() / ("giveway-admin-access-" + std::to_string(getpid()));
  ServiceFlags flags_;
};

TEST_F(AdminAccess, AnOrderGivenBeforeTheProcessWasStartedIsRefused) {
  const std::uint64_t now_ns = Now_ns();
  EXPECT_NE(WhyNot(now_ns), "");
  EXPECT_EQ(WhyNot(now_ns + kHour_ns), "");
}

// An operator's clock was an hour ahead: after the restart that its order asked for, the order, if
// it was recorded, could be given again.
TEST_F(AdminAccess, TheOrderForWhichItRestartedIsRefusedThoughItsClockWasAhead) {
  const std::uint64_t ahead = Now_ns() + kHour_ns;
  flags_.resume = Resumed{.session = {}, .order = ahead, .handover = {}};
  EXPECT_NE(WhyNot(ahead), "");
  EXPECT_NE(WhyNot(ahead - 1), "") << "before that one";
  EXPECT_EQ(WhyNot(ahead + 1), "");
}

TEST_F(AdminAccess, OneThatRestartedForNoOrderGoesByItsClock) {
  flags_.resume = Resumed{};
  EXPECT_NE(WhyNot(Now_ns()), "");
  EXPECT_EQ(WhyNot(Now_ns() + kHour_ns), "");
}

}  // namespace
}  // namespace giveway
