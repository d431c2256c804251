#include "services/types/discovery_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace giveway {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(DiscoveryServers, AreNamedInTheOrderOfTheirIds) {
  const auto parsed = ParseDiscoveryServers("10.0.0.2,discovery-1:11812");
  EXPECT_EQ(parsed.fault, "");
  EXPECT_THAT(parsed.servers, ElementsAre(DiscoveryServer{"10.0.0.2", 11811},
                                          DiscoveryServer{"discovery-1", 11812}));
  EXPECT_EQ(ToText(parsed.servers), "10.0.0.2:11811,discovery-1:11812");
}

TEST(DiscoveryServers, WhatIsWrongIsNamedAndNothingIsHalfRead) {
  const std::pair<std::string, std::string> cases[] = {
      {"", "\"\" is no host"},
      {"a,,b", "\"\" is no host"},
      {"a,", "\"\" is no host"},
      {"a b", "\"a b\" is no host"},
      {"http://a", "\"//a\" is no port"},
      {"a:", "\"\" is no port"},
      {"a:0", "\"0\" is no port"},
      {"a:65536", "\"65536\" is no port"},
      {"a:11811x", "\"11811x\" is no port"},
      {"a:-1", "\"-1\" is no port"},
      {std::string(254, 'a'), "is no host"},
      {"0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16", "more than 16"},
  };
  for (const auto& [text, fault] : cases) {
    const auto parsed = ParseDiscoveryServers(text);
    EXPECT_THAT(parsed.fault, HasSubstr(fault)) << text;
    EXPECT_THAT(parsed.servers, IsEmpty()) << text;
  }
}

TEST(DiscoveryServers, SixteenAreNotTooMany) {
  EXPECT_EQ(ParseDiscoveryServers("0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15").servers.size(), 16U);
}

}  // namespace
}  // namespace giveway
