#include "services/fleetctl/soak/host_faults/discovery_servers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/fleetctl/soak/process_faults.h"

namespace giveway::fleetctl {
namespace {

using faults::Kind;
using faults::Target;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsNull;
using testing::SizeIs;

TEST(DiscoveryServers, EachListensOnItsAddressUnderItsPlaceInTheList) {
  const auto commands = ServerCommands({{"127.0.0.1", 4000}, {"127.0.0.1", 4001}}, "/logs");
  ASSERT_THAT(commands, SizeIs(2));
  EXPECT_EQ(commands[1].member, (MemberId{MemberKind::kDiscoveryServer, 2}));
  EXPECT_EQ(commands[1].child.name, "discovery server 2");
  EXPECT_EQ(commands[1].child.log_file, "/logs/discovery-server-2.log");
  const auto& words = commands[1].child.words;
  ASSERT_THAT(words, SizeIs(9));
  EXPECT_THAT(std::vector(words.begin() + 1, words.end()),
              ElementsAre("-x", EndsWith("/deploy/discovery_server.xml"), "-i", "1", "-l",
                          "127.0.0.1", "-p", "4001"));
}

TEST(DiscoveryServers, ListenOnAnAddressAndNoName) {
  EXPECT_THAT(WhyNoDiscoveryServers("lo"), HasSubstr("'lo'"));
  EXPECT_THAT(WhyNoDiscoveryServers("any"), HasSubstr("--interface"));
}

faults::Fault OfAServer(Kind kind) {
  faults::Fault fault;
  fault.kind = kind;
  fault.target.what = Target::What::kDiscoveryServer;
  return fault;
}

TEST(DiscoveryServers, AreKilledRestartedAndPausedOnlyWhereThereAreSome) {
  for (const Kind kind : {Kind::kKill, Kind::kRestart, Kind::kPause}) {
    EXPECT_THAT(ProcessFaults::WhyNot(OfAServer(kind), true), IsNull());
    EXPECT_THAT(ProcessFaults::WhyNot(OfAServer(kind), false), HasSubstr("--discovery-servers"));
  }
}

}  // namespace
}  // namespace giveway::fleetctl
