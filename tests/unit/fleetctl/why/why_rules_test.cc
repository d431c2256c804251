#include "services/fleetctl/why/why_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/unit/fleetctl/why/why_situations.h"

namespace giveway::fleetctl {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr std::uint32_t kVehicles = 2;

struct Pair {
  ProcessSituation hearer = Vehicle(1);
  ProcessSituation speaker = Vehicle(2);
};

struct Case {
  const char* rule;
  std::function<void(Pair&)> spoil;
  Outlook outlook = Outlook::kCannot;
  Outlook in_place = Outlook::kCannot;
};

void PrintTo(const Case& one, std::ostream* out) { *out << one.rule; }

constexpr const char* kSlowDeadline =
    "<qos><deadline><period><sec>1</sec></period></deadline></qos>";
constexpr const char* kFastDeadline =
    "<qos><deadline><period><sec>0</sec><nanosec>150000000</nanosec></period></deadline></qos>";
constexpr const char* kPeers =
    "<builtin><initialPeersList><locator><udpv4><address>192.0.2.2</address></udpv4></locator>"
    "</initialPeersList></builtin>";

std::string Discovery(const char* protocol) {
  return "<builtin><discovery_config><discoveryProtocol>" + std::string(protocol) +
         "</discoveryProtocol></discovery_config></builtin>";
}

ImpairmentRule Loss(double loss) {
  ImpairmentRule rule;
  rule.loss = loss;
  return rule;
}

void MakeParticipant(ProcessSituation& situation, std::uint16_t id) {
  situation.ports = {{static_cast<std::uint16_t>(7400 + 250 * 7 + 10 + 2 * id)}};
}

const std::vector<Case>& Cases() {
  static const std::vector<Case> cases = {
      {"domain_apart",
       [](Pair& pair) {
         pair.speaker.launch.domain = 8;
         MakeParticipant(pair.speaker, 125);
       }},
      {"ports_apart",
       [](Pair& pair) { pair.speaker.profiles = SetWith("<port><offsetd0>4</offsetd0></port>"); }},
      {"whitelist_apart", [](Pair& pair) { pair.speaker.launch.interface = "eth0"; }},
      {"whitelist_apart", [](Pair& pair) { pair.speaker.launch.interface = "any"; }},
      {"whitelist_apart",
       [](Pair& pair) {
         for (ProcessSituation* one : {&pair.hearer, &pair.speaker}) {
           one->addresses->push_back({"eth0", kEthernetAddress + 1, 0xffffff00});
         }
         pair.hearer.launch.interface = "192.0.2.2";
         pair.speaker.launch.interface = "192.0.2.3";
       }},
      {"network_apart", [](Pair& pair) { pair.speaker.network_namespace = 4026531999; }},
      {"network_between",
       [](Pair& pair) {
         pair.speaker.network_namespace = 4026531999;
         pair.speaker.addresses = {{{"eth0", kEthernetAddress + 1, 0xffffff00}}};
         pair.hearer.launch.interface = pair.speaker.launch.interface = "any";
       },
       Outlook::kNotKnown, Outlook::kNotKnown},
      {"shared_memory_apart",
       [](Pair& pair) {
         pair.hearer.profiles = pair.speaker.profiles = SetWith("", "", "", true);
         pair.speaker.shared_memory = FileIdentity{23, 1};
       }},
      {"discovery_off", [](Pair& pair) { pair.speaker.profiles = SetWith(Discovery("NONE")); }},
      {"discovery_apart", [](Pair& pair) { pair.hearer.profiles = SetWith(Discovery("CLIENT")); }},
      {"discovery_apart",
       [](Pair& pair) { pair.speaker.launch.discovery_servers = {{"192.0.2.1"}}; }},
      {"discovery_by_server",
       [](Pair& pair) {
         pair.hearer.launch.discovery_servers = {{"192.0.2.1"}};
         pair.speaker.profiles = SetWith(Discovery("CLIENT"));
       },
       Outlook::kNotKnown, Outlook::kNotKnown},
      {"discovery_by_server",
       [](Pair& pair) {
         pair.hearer.profiles = pair.speaker.profiles = SetWith(Discovery("CLIENT"));
       },
       Outlook::kNotKnown, Outlook::kNotKnown},
      {"initial_peers_range",
       [](Pair& pair) {
         pair.hearer.profiles = pair.speaker.profiles = SetWith(kPeers);
         MakeParticipant(pair.hearer, 4);
         MakeParticipant(pair.speaker, 5);
       }},
      {"partition_apart", [](Pair& pair) { pair.speaker.launch.area = "north"; }},
      {"partition_apart",
       [](Pair& pair) {
         pair.speaker.launch.area = "north";
         pair.speaker.launch.partition_free = true;
       }},
      {"deadline_mismatch",
       [](Pair& pair) {
         pair.speaker.profiles = SetWith("", kSlowDeadline);
         pair.hearer.profiles = SetWith("", "", kFastDeadline);
       }},
      {"reliability_mismatch",
       [](Pair& pair) {
         pair.speaker.profiles =
             SetWith("", "<qos><reliability><kind>BEST_EFFORT</kind></reliability></qos>");
         pair.hearer.profiles =
             SetWith("", "", "<qos><reliability><kind>RELIABLE</kind></reliability></qos>");
       }},
      {"writer_instances",
       [](Pair& pair) {
         pair.speaker.profiles =
             SetWith("",
                     "<topic><resourceLimitsQos><max_instances>-1</max_instances>"
                     "</resourceLimitsQos></topic>");
       }},
      {"instance_limit",
       [](Pair& pair) {
         pair.hearer.profiles = SetWith("", "",
                                        "<topic><resourceLimitsQos><max_instances>1</max_instances>"
                                        "</resourceLimitsQos></topic>");
       },
       Outlook::kNotKnown, Outlook::kNotKnown},
      {"no_participant", [](Pair& pair) { pair.speaker.ports = {{5353}}; }},
      {"no_participant", [](Pair& pair) { pair.hearer.ports = {{5353}}; }, Outlook::kCannot,
       Outlook::kHears},
      {"process_stopped", [](Pair& pair) { pair.speaker.state = 'T'; }},
      {"process_stopped", [](Pair& pair) { pair.hearer.state = 't'; }, Outlook::kCannot,
       Outlook::kHears},
      {"open_files_limit", [](Pair& pair) { pair.hearer.open_files = 1020; }, Outlook::kHears,
       Outlook::kHears},
      {"profiles_changed", [](Pair& pair) { pair.speaker.profiles_changed = true; },
       Outlook::kHears, Outlook::kHears},
      {"misnamed_variable",
       [](Pair& pair) {
         pair.speaker.environment = {"SKIP_DEFAULT_XML=1", "PATH=/bin"};
       },
       Outlook::kHears, Outlook::kHears},
      {"impaired_deaf", [](Pair& pair) { pair.hearer.launch.impairment.rules = {Loss(1)}; }},
      {"impaired_much", [](Pair& pair) { pair.hearer.launch.impairment.rules = {Loss(0.6)}; },
       Outlook::kHears, Outlook::kHears},
      {"impaired_blackout",
       [](Pair& pair) {
         pair.hearer.launch.impairment.rules = {Loss(0)};
         pair.hearer.launch.impairment.rules[0].blackouts = {{3, 5}};
       },
       Outlook::kNotKnown, Outlook::kNotKnown},
      {"impaired_for_a_time",
       [](Pair& pair) {
         pair.hearer.launch.impairment.rules = {Loss(1)};
         pair.hearer.launch.impairment.rules[0].from_s = 60;
       },
       Outlook::kNotKnown, Outlook::kNotKnown},
  };
  return cases;
}

TopicOutlook Foretold(const Pair& pair) {
  const auto topics = Predict(pair.hearer, pair.speaker, kVehicles);
  EXPECT_THAT(topics, SizeIs(1));
  return topics.front();
}

std::vector<std::string> RulesOf(const TopicOutlook& topic) {
  std::vector<std::string> rules;
  for (const Cause& cause : topic.causes) rules.push_back(cause.finding.rule);
  return rules;
}

class WhyRules : public testing::TestWithParam<Case> {};

TEST_P(WhyRules, OneSpoiltFactIsFoundOnceAndNothingElseIs) {
  Pair pair;
  GetParam().spoil(pair);
  const TopicOutlook topic = Foretold(pair);
  EXPECT_THAT(RulesOf(topic), ElementsAre(GetParam().rule));
  EXPECT_EQ(topic.outlook, GetParam().outlook);
  EXPECT_EQ(topic.in_place, GetParam().in_place);
}

TEST_P(WhyRules, AFindingSaysWhoWhatFollowsAndWhatToDo) {
  Pair pair;
  GetParam().spoil(pair);
  for (const Cause& cause : Foretold(pair).causes) {
    EXPECT_THAT(cause.finding.subject + cause.finding.values,
                testing::AnyOf(HasSubstr("vehicle 1 (pid 101)"), HasSubstr("vehicle 2 (pid 102)")));
    EXPECT_NE(cause.finding.consequence, "");
    EXPECT_NE(cause.finding.remedy, "");
    EXPECT_EQ(cause.finding.severity == qos::Severity::kError, cause.weight == Weight::kPrevents);
  }
}

INSTANTIATE_TEST_SUITE_P(Every, WhyRules, testing::ValuesIn(Cases()),
                         [](const testing::TestParamInfo<Case>& one) {
                           return std::to_string(one.index) + "_" + one.param.rule;
                         });

TEST(WhyPrediction, TwoVehiclesThatStandAlikeHearEachOther) {
  const TopicOutlook topic = Foretold({});
  EXPECT_THAT(topic.causes, IsEmpty());
  EXPECT_EQ(topic.outlook, Outlook::kHears);
  EXPECT_EQ(topic.topic, "fleet/beacon");
  EXPECT_EQ(topic.read_in, "main/*");
}

TEST(WhyPrediction, BothValuesOfAPolicyAreNamedWithTheirLines) {
  Pair pair;
  pair.speaker.profiles = SetWith("", kSlowDeadline);
  pair.hearer.profiles = SetWith("", "", kFastDeadline);
  EXPECT_EQ(Foretold(pair).causes.front().finding.values,
            "vehicle 2 (pid 102) offers deadline 1 s (set.xml:2), vehicle 1 (pid 101) requests "
            "deadline 150 ms (set.xml:3)");
}

TEST(WhyPrediction, TheFirstCauseComesFirstWhateverElseIsWrong) {
  Pair pair;
  pair.hearer.launch.impairment.rules = {Loss(1)};
  pair.speaker.launch.area = "north";
  pair.speaker.state = 'T';
  pair.speaker.profiles_changed = true;
  pair.speaker.network_namespace = 4026531999;
  EXPECT_THAT(RulesOf(Foretold(pair)),
              ElementsAre("network_apart", "partition_apart", "process_stopped", "impaired_deaf",
                          "profiles_changed"));
}

TEST(WhyPrediction, AnImpairmentOfOthersIsNoReason) {
  Pair pair;
  ImpairmentRule of_third = Loss(1);
  of_third.from = ImpairedSender::kOneVehicle;
  of_third.from_vehicle = VehicleId{3};
  ImpairmentRule for_third = Loss(1);
  for_third.to_vehicle = VehicleId{3};
  ImpairmentRule of_world = Loss(1);
  of_world.from = ImpairedSender::kWorld;
  pair.hearer.launch.impairment.rules = {of_third, for_third, of_world};
  pair.speaker.launch.impairment.rules = {Loss(1)};  // of what it hears itself
  EXPECT_THAT(RulesOf(Foretold(pair)), IsEmpty());
}

TEST(WhyPrediction, OfTheImpairmentRulesThatFitTheLastCounts) {
  Pair pair;
  ImpairmentRule mild = Loss(0.1);
  mild.from = ImpairedSender::kVehicles;
  pair.hearer.launch.impairment.rules = {Loss(1), mild};
  EXPECT_THAT(RulesOf(Foretold(pair)), IsEmpty());
}

TEST(WhyPrediction, AnyInterfaceMeetsAWhitelistWhereThereIsOnlyTheLoopback) {
  Pair pair;
  pair.hearer.launch.interface = "any";
  for (ProcessSituation* one : {&pair.hearer, &pair.speaker}) one->addresses->resize(1);
  EXPECT_THAT(RulesOf(Foretold(pair)), IsEmpty());
}

TEST(WhyPrediction, SharedMemoryApartIsNoReasonWhereOneHasItAlone) {
  Pair pair;
  pair.hearer.profiles = SetWith("", "", "", true);
  pair.speaker.shared_memory = FileIdentity{23, 1};
  EXPECT_THAT(RulesOf(Foretold(pair)), IsEmpty());
}

TEST(WhyPrediction, SharedMemoryApartIsNoReasonBetweenTwoHosts) {
  Pair pair;
  pair.hearer.profiles = pair.speaker.profiles = SetWith("", "", "", true);
  pair.speaker.shared_memory = FileIdentity{23, 1};
  pair.speaker.network_namespace = 4026531999;
  pair.speaker.addresses = {{{"eth0", kEthernetAddress + 1, 0xffffff00}}};
  pair.hearer.launch.interface = pair.speaker.launch.interface = "any";
  EXPECT_THAT(RulesOf(Foretold(pair)), ElementsAre("network_between"));
}

TEST(WhyPrediction, WithoutAFactItRestsOnItIsNotKnown) {
  for (const auto& forget : std::vector<std::function<void(ProcessSituation&)>>{
           [](ProcessSituation& one) { one.network_namespace.reset(); },
           [](ProcessSituation& one) { one.addresses.reset(); },
           [](ProcessSituation& one) { one.profiles.reset(); },
           [](ProcessSituation& one) { one.state.reset(); }}) {
    Pair pair;
    forget(pair.speaker);
    EXPECT_EQ(Foretold(pair).outlook, Outlook::kNotKnown);
    pair.hearer.launch.area = "north";  // and yet what is known may decide
    EXPECT_EQ(Foretold(pair).outlook, Outlook::kCannot);
  }
}

TEST(WhyTopics, AVehicleReadsOfTheWorldWhatItIsFittedWith) {
  LaunchOptions vehicle;
  vehicle.id = VehicleId{4};
  vehicle.radar = vehicle.signals = true;
  LaunchOptions world;
  world.is_world = true;
  std::vector<std::string> read;
  for (const TopicOutlook& topic : TopicsBetween(vehicle, world)) {
    read.push_back(topic.topic + " in " + topic.read_in);
  }
  EXPECT_THAT(read, ElementsAre("world/ranges in v4", "world/radar in v4", "world/signal in world",
                                "world/roster in world"));
  EXPECT_THAT(TopicsBetween(world, vehicle), SizeIs(2));
  EXPECT_THAT(TopicsBetween(world, world), IsEmpty());
}

TEST(WhySituation, HostIdIsThatOfFastDdsForTheAddressesBesideTheLoopback) {
  ProcessSituation process = Vehicle(1);
  EXPECT_EQ(HostId(process), 0xfd78);  // as Fast DDS 2.9.1 reported on a machine with 192.0.2.2
  process.addresses->resize(1);
  EXPECT_EQ(HostId(process), 0x017f);
  process.addresses.reset();
  EXPECT_EQ(HostId(process), std::nullopt);
}

}  // namespace
}  // namespace giveway::fleetctl
