// Vehicles that discover each other through a discovery server, and report while none answers. The
// server is a participant of this process; fast-discovery-server is another.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <string>

#include "services/link/fastdds/fastdds_version.h"
#include "services/link/fastdds/server_addresses.h"
#include "services/node/server_wait.h"
#include "tests/link/fleet.h"

namespace giveway::test {
namespace {

using ::testing::HasSubstr;
namespace dds = link::dds;
namespace rtps = link::rtps;

struct Delete {
  void operator()(dds::DomainParticipant* participant) const {
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant);
  }
};
using Server = std::unique_ptr<dds::DomainParticipant, Delete>;

// As `fast-discovery-server -i 0 -l 127.0.0.1 -p PORT` is one.
Server MakeServer(std::uint32_t domain, std::uint16_t port) {
  dds::DomainParticipantQos qos;
  auto udp = std::make_shared<link::transport::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {"127.0.0.1"};
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  const std::array<rtps::octet, 12> prefix{0x44, 0x53, 0,    0x5f, 0x45, 0x50,
                                           0x52, 0x4f, 0x53, 0x49, 0x4d, 0x41};
  std::ranges::copy(prefix, qos.wire_protocol().prefix.value);
  qos.wire_protocol().builtin.discovery_config.discoveryProtocol = link::Discovery::SERVER;
  rtps::Locator_t address;
  rtps::IPLocator::setIPv4(address, "127.0.0.1");
  rtps::IPLocator::setPhysicalPort(address, port);
  qos.wire_protocol().builtin.metatrafficUnicastLocatorList.push_back(address);
  return Server(dds::DomainParticipantFactory::get_instance()->create_participant(domain, qos));
}

class DiscoveryServerTest : public ::testing::Test {
 protected:
  DiscoveryServerTest() : options_(OptionsIn(domain_)) {
    options_.discovery_servers = {{"localhost", port_}};
  }

  DomainLock domain_;
  // Used by no participant of any domain: their ports start at 7400 + 250.
  std::uint16_t port_ = static_cast<std::uint16_t>(7000 + domain_.Domain());
  link::LinkOptions options_;
};

TEST_F(DiscoveryServerTest, BringsThoseTogetherWhoKnowItsAddressAndNobodyElse) {
  const Server server = MakeServer(domain_.Domain(), port_);
  ASSERT_NE(server, nullptr);
  Beaconing one(options_, VehicleId{1});
  Beaconing two(options_, VehicleId{2});
  link::LinkOptions by_multicast = options_;
  by_multicast.discovery_servers.clear();
  Beaconing three(by_multicast, VehicleId{3});
  ReceptionMonitor monitor(two.Link());
  const auto speak = [&] {
    one.Send();
    three.Send();
    monitor.Listen();
  };
  EXPECT_TRUE(Eventually([&] {
    speak();
    return monitor.Heard().contains(VehicleId{1});
  }));
  Repeat(std::chrono::milliseconds(500), speak);
  EXPECT_FALSE(monitor.Heard().contains(VehicleId{3}));
  EXPECT_EQ(two.Link().WhyNoPeerIsFound(), "");
}

TEST_F(DiscoveryServerTest, ThatDoesNotAnswerIsNamedUntilItDoes) {
  Beaconing one(options_, VehicleId{1});
  const std::string port = std::to_string(port_);
  EXPECT_THAT(one.Link().WhyNoPeerIsFound(),
              AllOf(HasSubstr("no discovery server answers"), HasSubstr("localhost:" + port)));
  const Server server = MakeServer(domain_.Domain(), port_);
  EXPECT_TRUE(Eventually([&] { return one.Link().WhyNoPeerIsFound().empty(); }));
}

// Of a slow name server the second answer took so long that the watchdog ended the vehicle.
TEST_F(DiscoveryServerTest, IsNotLookedUpOnceMoreByTheLink) {
  const std::string unknown(64, 'n');  // no name at all: looked up, it has no address
  const Server server = MakeServer(domain_.Domain(), port_);
  options_.discovery_servers = {{unknown, port_}};
  options_.server_addresses = {{"127.0.0.1", port_}};
  Beaconing one(options_, VehicleId{1});
  EXPECT_TRUE(Eventually([&] { return one.Link().WhyNoPeerIsFound().empty(); }));
}

TEST_F(DiscoveryServerTest, HasItsAddressFromTheWaitForIt) {
  const StopSignal stop;
  const auto found = AwaitServers(options_, stop, [](const std::string&) {});
  ASSERT_TRUE(found.has_value());
  ASSERT_EQ(found->size(), 1U);
  EXPECT_EQ(found->front().ipv4, "127.0.0.1");
  EXPECT_EQ(found->front().port, port_);
}

TEST_F(DiscoveryServerTest, IsNotMissedWhereMulticastFindsEverybody) {
  options_.discovery_servers.clear();
  Beaconing one(options_, VehicleId{1});
  EXPECT_EQ(one.Link().WhyNoPeerIsFound(), "");
}

TEST(ServerAddresses, AreThoseOfTheNamesAndOfNumbersAsTheyAre) {
  const auto [addresses, fault] = link::FindServers({{"localhost", 1}, {"10.1.2.3", 2}});
  EXPECT_EQ(fault, "");
  ASSERT_EQ(addresses.size(), 2U);
  EXPECT_EQ(addresses[0].ipv4, "127.0.0.1");
  EXPECT_EQ(addresses[1].ipv4, "10.1.2.3");
  EXPECT_EQ(addresses[1].port, 2U);
}

// A label of more than 63 letters is no name at all: no name server is asked for it.
TEST(ServerAddresses, OfANameThatHasNoneIsSaid) {
  const std::string unknown(64, 'n');
  EXPECT_THAT(link::FindServers({{"localhost", 1}, {unknown, 1}}).fault,
              AllOf(HasSubstr("discovery server " + unknown + " ("),
                    HasSubstr("has no address yet"), ::testing::Not(HasSubstr("localhost"))));
}

}  // namespace
}  // namespace giveway::test
