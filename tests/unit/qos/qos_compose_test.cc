// What a compose file says about a fleet's services, and what is found in it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/qos/compose.h"
#include "services/qos/compose_text.h"
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

// Expansions that were not known gave the shipped default to be checked instead, silently.
TEST(Compose, ExpandsVariablesAsComposeDoes) {
  const std::vector<std::string> variables = {"SET=same_host", "EMPTY=", "SET=other"};
  ComposeText text(variables);
  EXPECT_EQ(text.Expanded("$SET-${SET}"), "same_host-same_host");
  EXPECT_EQ(text.Expanded("${SET:?set it}${SET?}${SET:-x}${SET-x}"),
            "same_hostsame_hostsame_hostsame_host");
  EXPECT_EQ(text.Expanded("${SET:+with}${SET+with}${EMPTY:+with}${EMPTY+with}${NO+with}"),
            "withwithwith");
  EXPECT_EQ(text.Expanded("${EMPTY:-a}${EMPTY-b}${NO:-c}${NO-d}$NO"), "acd");
  EXPECT_EQ(text.Expanded("${NO:-${SET}/${NO:-deep}}}"), "same_host/deep}");
  EXPECT_EQ(text.Expanded("$$SET costs 5$ ${SET"), "$SET costs 5$ ${SET");
  EXPECT_THAT(text.Missing(), IsEmpty());
  EXPECT_EQ(text.Expanded("${NO:?why}${EMPTY?}${EMPTY:?why}"), "");
  EXPECT_THAT(text.Missing(), ElementsAre("EMPTY", "NO"));
}

TEST(Compose, ReadsTheEnvFileNextToIt) {
  EXPECT_THAT(EnvFileVariables("# no\n\nA=1\n export B = no\nexport C='x # y' # why\r\n"
                               "D=a b # why\nE=\nno\nA=2"),
              ElementsAre("A=2", "E=", "D=a b", "C=x # y", "A=1"));
}

TEST(Compose, SaysWhatMustBeSet) {
  const ComposeRead read = Read("services:\n  a:\n    image: giveway:${TAG:?}\n");
  EXPECT_THAT(RulesOf(read.findings), ElementsAre("compose_variable_missing"));
  EXPECT_EQ(read.findings.front().subject, "TAG");
}

TEST(Compose, TakesTheDomainOfTheCommandBeforeTheVariable) {
  const auto split = [](const std::string& command) {
    const ComposeRead read = Read(
        "services:\n"
        "  a: {image: giveway, environment: {GIVEWAY_DOMAIN: 1}}\n"
        "  b: {image: giveway, environment: {GIVEWAY_DOMAIN: 1}, command: [" +
        command + "]}\n");
    Findings findings;
    CheckCompose(read.services, &findings);
    return RulesOf(findings);
  };
  EXPECT_THAT(split("--domain, \"8\""), ElementsAre("domain_split"));
  EXPECT_THAT(split("--domain=8"), ElementsAre("domain_split"));
  EXPECT_THAT(split("--domain, \"1\""), IsEmpty());
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

TEST(Compose, MergesListsOfMapsOfWhichTheFirstCountsMost) {
  const ComposeRead read = Read(
      "x-a: &a {GIVEWAY_DOMAIN: 7}\n"
      "x-b: &b {GIVEWAY_DOMAIN: 8, GIVEWAY_QOS: lossy_radio}\n"
      "services: {v: {image: giveway, environment: {<<: [*a, *b], GIVEWAY_ID: 1}}}\n");
  ASSERT_EQ(read.services.size(), 1U);
  EXPECT_EQ(read.services[0].domain.value, "7");
  EXPECT_EQ(read.services[0].qos, "lossy_radio");
}

TEST(Compose, TakesAVariableWithoutAValueFromTheShell) {
  for (const std::string_view environment : {"{GIVEWAY_QOS: }", "[GIVEWAY_QOS]"}) {
    const std::string text =
        "services: {v: {image: giveway, environment: " + std::string(environment) + "}}\n";
    EXPECT_EQ(Read(text, {"GIVEWAY_QOS=same_host"}).services.at(0).qos, "same_host");
    EXPECT_THAT(Read(text).services.at(0).environment, IsEmpty());
  }
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
