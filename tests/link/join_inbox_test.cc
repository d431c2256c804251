// A flood of join requests displaces those of no other vehicle.
#include "services/link/inbox/join_inbox.h"

#include <gmock/gmock.h>

#include <set>

#include "services/link/participant.h"
#include "services/link/world_link.h"
#include "tests/link/fleet.h"

namespace giveway::test {
namespace {

JoinRequest Of(std::uint32_t session, bool leaving = false) {
  return {.session = {session, 1, 2, 3}, .wanted = kNoVehicle, .leaving = leaving};
}

// Issue 21, number 12.
TEST(JoinInbox, OfAProcessThatClaimsThousandsOfSessionsAFewAreHeardAndOthersStill) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  link::VehicleLink flood(OptionsIn(domain));
  link::VehicleLink honest(OptionsIn(domain));
  std::set<SessionId> heard;
  const auto take = [&] {
    for (const JoinRequest& request : world.TakeJoins()) heard.insert(request.session);
  };
  flood.SendJoin(Of(1));
  ASSERT_TRUE(Eventually([&] {
    take();
    return heard.contains(Of(1).session);
  }));
  for (std::uint32_t i = 2; i < 3000; ++i) {
    flood.SendJoin(Of(i));
    if (i % 100 == 0) take();
  }
  honest.SendJoin(Of(5000));
  EXPECT_TRUE(Eventually([&] {
    take();
    return heard.contains(Of(5000).session);
  }));
  EXPECT_LE(heard.size(), 20U);
  EXPECT_TRUE(Eventually([&] {
    take();
    return world.Counters().joins_refused > 2000;
  })) << world.Counters().joins_refused;
}

}  // namespace
}  // namespace giveway::test
