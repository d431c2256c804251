#include "services/observer/server/request_rules.h"

#include <gtest/gtest.h>

#include "services/observer/server/frame_board.h"

namespace giveway {
namespace {

TEST(IsOwnHost, AddressesAndLocalhostAre) {
  for (const char* host : {"127.0.0.1", "127.0.0.1:8080", "localhost", "LOCALHOST:80", "[::1]",
                           "[::1]:8080", "10.1.2.3:65535"}) {
    EXPECT_TRUE(IsOwnHost(host, {})) << host;
  }
}

TEST(IsOwnHost, NamesOfOthersAreNot) {
  for (const char* host : {"", "evil.example", "evil.example:8080", "127.0.0.1.evil.example",
                           "localhost.evil.example", "127.0.0.1:80a", "127.0.0.1:", "[::1", "[]",
                           "[::1]x", "[evil]", "0x7f.1", "user@localhost"}) {
    EXPECT_FALSE(IsOwnHost(host, {})) << host;
  }
  EXPECT_FALSE(IsOwnHost(std::string(300, 'a'), {}));
}

TEST(IsOwnHost, AGivenNameIsWholeAndInAnyCase) {
  EXPECT_TRUE(IsOwnHost("fleet.example:8080", {"Fleet.example"}));
  EXPECT_FALSE(IsOwnHost("fleet.example.evil", {"fleet.example"}));
}

TEST(VehicleOfPath, TakesWholeNumbersAlone) {
  EXPECT_EQ(VehicleOfPath("7"), VehicleId{7});
  EXPECT_EQ(VehicleOfPath("4294967295"), VehicleId{4294967295});
  for (const char* rest : {"", "0", "07", "-1", "7/", "7x", "4294967296", "../7", "%37"}) {
    EXPECT_FALSE(VehicleOfPath(rest)) << rest;
  }
}

TEST(FrameBoard, AClientGetsTheNewestAndNeverAQueue) {
  FrameBoard board;
  EXPECT_EQ(board.Wait(0, Nanoseconds{0}).first, nullptr);
  board.Publish("one");
  board.Publish("two");
  const auto [frame, number] = board.Wait(0, Nanoseconds{0});
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(*frame, "two");
  EXPECT_EQ(board.Wait(number, Nanoseconds{0}).first, nullptr);
  board.Close();
  EXPECT_EQ(board.Wait(0, std::chrono::hours(1)).first, nullptr);
}

}  // namespace
}  // namespace giveway
