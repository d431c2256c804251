// What a compose file says about a fleet's services, and what is found in it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/qos/compose.h"
#include "services/qos/profile_check.h"
#include "tests/unit/qos/qos_files.h"

namespace giveway::qos {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::string_view kFleet = R"(
x-fleet: &fleet
  image: giveway:${TAG:-latest}
  environment: &variables
    GIVEWAY_DOMAIN: 7
    GIVEWAY_QOS: /etc/giveway/mine.xml
  volumes:
    - ./qos:/etc/giveway:ro
services:
  database:
    image: postgres
  world:
    <<: *fleet
    command: [giveway-world, --scenario, four_way]
  vehicle:
    <<: *fleet
    command: giveway-vehicle --qos ${SET}
    environment:
      <<: *variables
      GIVEWAY_DOMAIN: "8"
    deploy:
      replicas: 12
)";

ComposeRead Read(std::string_view text, const std::vector<std::string>& variables = {}) {
  return ReadCompose(text, "compose.yaml", variables);
}

std::vector<std::string> RulesOf(const Findings& findings) {
  std::vector<std::string> rules;
  for (const Finding& finding : findings) rules.push_back(finding.rule);
  return rules;
}

TEST(Compose, IsReadThroughAnchorsMergesAndVariables) {
  const ComposeRead read = Read(kFleet, {"OTHER=x", "SET=same_host"});
  EXPECT_THAT(read.findings, IsEmpty());
  ASSERT_EQ(read.services.size(), 2U);
  const ComposeService& world = read.services[0];
  EXPECT_EQ(world.name, "world");
  EXPECT_EQ(world.qos, "/etc/giveway/mine.xml");
  EXPECT_EQ(HostPath(world, world.qos), "./qos/mine.xml");
  EXPECT_FALSE(world.is_vehicle);
  const ComposeService& vehicle = read.services[1];
  EXPECT_TRUE(vehicle.is_vehicle);
  EXPECT_EQ(vehicle.containers, 12);
  EXPECT_EQ(vehicle.qos, "same_host");  // the flag counts more than the variable
  EXPECT_EQ(vehicle.qos_place.line, 17);
}

TEST(Compose, TakesListsAsItTakesMaps) {
  const ComposeRead read = Read(
      "services:\n"
      "  a:\n"
      "    entrypoint: [\"giveway-vehicle\", \"--qos=lossy_radio\"]\n"
      "    environment: [GIVEWAY_DOMAIN=5, GIVEWAY_ID]\n"
      "    volumes: [{type: bind, source: /here, target: /there}]\n"
      "    network_mode: host\n"
      "    ipc: host\n"
      "    scale: 3\n",
      {"GIVEWAY_ID=4"});
  ASSERT_EQ(read.services.size(), 1U);
  const ComposeService& service = read.services[0];
  ASSERT_EQ(service.environment.size(), 2U);
  EXPECT_EQ(service.environment[0].value, "5");
  EXPECT_EQ(service.environment[1].value, "4");
  EXPECT_EQ(HostPath(service, "/there/x.xml"), "/here/x.xml");
  EXPECT_EQ(HostPath(service, "/thereabouts/x.xml"), "");
  EXPECT_TRUE(service.host_network && service.host_ipc && service.is_vehicle);
  EXPECT_EQ(service.containers, 3);
}

TEST(Compose, SaysWhichServicesNeverHearOfEachOther) {
  Findings findings;
  CheckCompose(Read(kFleet, {}).services, &findings);
  ASSERT_THAT(RulesOf(findings), ElementsAre("domain_split"));
  EXPECT_EQ(findings[0].place.line, 20);
  EXPECT_EQ(findings[0].subject, "vehicle");
}

TEST(Compose, NamesAVariableThatNobodyReads) {
  Findings findings;
  CheckCompose(Read("services: {a: {environment: {GIVEWAY_DOMIAN: 5}}}").services, &findings);
  EXPECT_THAT(RulesOf(findings), ElementsAre("misnamed_variable"));
}

// What a fleet gets whose containers share a network, shared memory, or both.
std::vector<std::string> RulesWith(const std::string& network, const std::string& set) {
  const ComposeRead read =
      Read("services: {v: {image: giveway-vehicle" + network + ", environment: {}}}");
  const std::vector<ProfileFile> files = {
      {set, BytesOf(std::string(GIVEWAY_QOS_SETS) + "/" + set + ".xml")}};
  return RulesOf(Check(files, {}, {{0, read.services.at(0)}}));
}

TEST(Compose, HoldsSharedMemoryAgainstTheNetworkOfItsContainers) {
  EXPECT_THAT(RulesWith(", network_mode: host", "same_host"),
              ElementsAre("host_network_without_ipc"));
  EXPECT_THAT(RulesWith("", "same_host"), ElementsAre("shared_memory_apart"));
  EXPECT_THAT(RulesWith(", network_mode: host, ipc: host", "same_host"), IsEmpty());
  EXPECT_THAT(RulesWith(", network_mode: host", "default"), IsEmpty());
}

TEST(Compose, SaysWhatItDidNotRead) {
  EXPECT_THAT(RulesOf(Read("services: {a: {image: giveway, env_file: x.env}}").findings),
              ElementsAre("env_file_not_read"));
  EXPECT_THAT(RulesOf(Read("services: {a: {image: giveway, scale: many}}").findings),
              ElementsAre("compose_count"));
  EXPECT_THAT(RulesOf(Read("services: {a: {image: postgres}}").findings),
              ElementsAre("no_fleet_services"));
}

TEST(Compose, ThatIsNoneIsAFindingAndNeverACrash) {
  EXPECT_THAT(RulesOf(Read("services: [\n").findings), ElementsAre("malformed_yaml"));
  EXPECT_THAT(RulesOf(Read(std::string(100'000, '[')).findings), ElementsAre("malformed_yaml"));
  for (const std::string_view text :
       {"", "x", "[]", "services:", "services: x", "services: [a]", "services: {a: }",
        "services: {a: {environment: x, command: {}, volumes: {}, deploy: []}}",
        "services: {? [a] : {image: giveway}}"}) {
    EXPECT_THAT(RulesOf(Read(text).findings), ElementsAre("no_fleet_services")) << text;
  }
}

TEST(Compose, ThatMergesIntoItselfIsReadOnce) {
  EXPECT_EQ(Read("services: {a: &a {<<: *a, image: giveway}}").services.size(), 1U);
  EXPECT_EQ(Read("services: {a: {image: giveway, environment: &e {<<: *e, X: 1}}}").services.size(),
            1U);
  EXPECT_EQ(Read("services: {a: {image: 'giveway${X}'}}", {"X=${X}${X}"}).services.size(), 1U);
}

// Nine merges into nine merges, thirty levels deep: expanding all of them would never end.
TEST(Compose, ThatMultipliesIsGivenUpEarly) {
  std::string text = "a0: &a0 {x: giveway}\n";
  for (int i = 1; i < 30; ++i) {
    const std::string before = "*a" + std::to_string(i - 1);
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " {<<: [";
    for (int j = 0; j < 9; ++j) text += (j > 0 ? "," : "") + before;
    text += "]}\n";
  }
  EXPECT_THAT(RulesOf(Read(text + "services: {v: *a29}\n").findings),
              Contains("no_fleet_services"));
}

}  // namespace
}  // namespace giveway::qos
