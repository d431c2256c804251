#include "services/fleetctl/doctor/doctor_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/fleetctl/doctor/doctor_hosts.h"

namespace giveway::fleetctl {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> RulesOf(const HostFacts& host) {
  std::vector<std::string> rules;
  for (const qos::Finding& finding : Examine(host)) rules.push_back(finding.rule);
  return rules;
}

// The only finding, which says everything.
qos::Finding Only(const HostFacts& host) {
  const qos::Findings findings = Examine(host);
  EXPECT_EQ(findings.size(), 1U);
  if (findings.empty()) return {};
  EXPECT_NE(findings.front().values, "");
  EXPECT_NE(findings.front().consequence, "");
  EXPECT_NE(findings.front().remedy, "");
  return findings.front();
}

// A set that asks for a receive buffer, and one whose beacons expire.
qos::ProfileSet SetOf(const std::string& transport, const std::string& writer) {
  const std::string text =
      "<dds><profiles><transport_descriptors><transport_descriptor>"
      "<transport_id>udp</transport_id><type>UDPv4</type>" +
      transport +
      "</transport_descriptor></transport_descriptors><participant "
      "profile_name=\"giveway_participant\"><rtps><userTransports><transport_id>udp</transport_id>"
      "</userTransports></rtps></participant><data_writer profile_name=\"fleet_beacon_writer\">" +
      writer + "</data_writer></profiles></dds>";
  return qos::ReadProfiles(*qos::ReadXml(text, "set.xml").root, "set.xml");
}

TEST(Doctor, FindsNothingOnAHealthyHost) { EXPECT_THAT(RulesOf(HealthyHost()), IsEmpty()); }

TEST(Doctor, FindsNothingWhereNothingCouldBeRead) {
  HostFacts host;
  host.interfaces = HealthyHost().interfaces;
  host.domains = {7};
  EXPECT_THAT(RulesOf(host), IsEmpty());
}

TEST(Doctor, FindsFilesWhoseOwnerIsGone) {
  HostFacts host = HealthyHost();
  AddStaleSegment("fastrtps_00000000000000aa", &host.memory);
  const qos::Finding found = Only(host);
  EXPECT_EQ(found.rule, "memory_stale");
  EXPECT_THAT(found.values, HasSubstr("2 files of 1 segment or port"));
  EXPECT_THAT(found.values, HasSubstr("fastrtps_00000000000000aa"));
}

TEST(Doctor, FindsPartsThatBelongToNothing) {
  HostFacts host = HealthyHost();
  host.memory.files.push_back(FileNamed("fastrtps_port9160_el"));
  host.memory.files.push_back(FileNamed("fastrtps_port9170"));
  host.memory.files.push_back(FileNamed("sem.fastrtps_port9172_mutex"));
  EXPECT_EQ(Only(host).rule, "memory_orphaned");
  EXPECT_THAT(Only(host).values, HasSubstr("3 files of 3 segments and ports"));
}

TEST(Doctor, FindsFilesOfOthersThatItsUserCannotOpen) {
  HostFacts host = HealthyHost();
  for (MemoryFile& file : host.memory.files) file.user = 1001;
  EXPECT_EQ(Only(host).rule, "memory_foreign");
  EXPECT_THAT(Only(host).values, HasSubstr("is user 1001's, and you are user 1000"));
  host.user = 0;
  EXPECT_THAT(RulesOf(host), IsEmpty()) << "root opens everything";
  host.user = 1000;
  for (MemoryFile& file : host.memory.files) file.mode = 0666;
  EXPECT_THAT(RulesOf(host), IsEmpty()) << "all may open them";
}

TEST(Doctor, FindsSharedMemoryWithoutRoom) {
  HostFacts host = HealthyHost();
  host.memory.free_bytes = 500'000;
  EXPECT_EQ(Only(host).rule, "memory_full");
  EXPECT_EQ(Only(host).severity, qos::Severity::kError);
  host.planned.profiles = SetWith();
  EXPECT_THAT(RulesOf(host), IsEmpty()) << "a set without SHM needs none";
  host.memory.free_bytes = 0;
  EXPECT_EQ(Only(host).severity, qos::Severity::kWarning);
}

TEST(Doctor, FindsSharedMemoryWithoutRoomForAll) {
  HostFacts host = HealthyHost();
  host.vehicles = 90;
  host.memory.free_bytes = 50'000'000;
  EXPECT_EQ(Only(host).rule, "memory_small");
  EXPECT_THAT(Only(host).consequence, HasSubstr("of 90 more participants"));
  host.memory.free_bytes = 100'000'000;
  EXPECT_THAT(RulesOf(host), IsEmpty());
}

TEST(Doctor, CountsTheSegmentsOfOtherFleetsForNoneOfThisOne) {
  HostFacts host = HealthyHost();
  host.vehicles = 90;
  host.memory.free_bytes = 50'000'000;
  for (int i = 0; i < 90; ++i) {
    host.processes.push_back(Vehicle(3 + static_cast<std::uint32_t>(i)));
    host.processes.back().launch.domain = 9;
    host.processes.back().profiles = SetWith();  // nor does it use shared memory
  }
  EXPECT_THAT(RulesOf(host), testing::Contains("memory_small"));
}

TEST(Doctor, FindsAHostsNetworkWithoutItsSharedMemory) {
  HostFacts host = HealthyHost();
  host.processes[1].shared_memory = FileIdentity{23, 1};
  EXPECT_EQ(Only(host).rule, "shared_memory_apart");
  EXPECT_THAT(Only(host).remedy, HasSubstr("--ipc=host"));
  host.processes[1].launch.leaves_out_shared_memory = true;
  EXPECT_THAT(RulesOf(host), IsEmpty()) << "its shared memory was deleted: it keeps to UDP";
  host.processes[1].launch.leaves_out_shared_memory = false;
  for (ProcessSituation& process : host.processes) process.profiles = SetWith();
  EXPECT_THAT(RulesOf(host), IsEmpty()) << "over UDP they hear each other";
}

TEST(Doctor, SaysOnceWhatHoldsForManyProcesses) {
  HostFacts host = HealthyHost();
  for (std::uint32_t id = 3; id < 20; ++id) {
    host.processes.push_back(host.processes[id % 2]);
    host.processes.back().pid += static_cast<int>(id);
    if (id % 2 == 1) host.processes.back().shared_memory = FileIdentity{23, 1};
  }
  EXPECT_THAT(RulesOf(host), ElementsAre("shared_memory_apart"));
}

TEST(Doctor, FindsHostIdsThatDiffer) {
  HostFacts host = HealthyHost();
  host.processes[1].network_namespace = 4026539999;
  host.processes[1].addresses = {{{"lo", kLoopbackAddress, 0xff000000}}};
  EXPECT_EQ(Only(host).rule, "host_ids_apart");
  EXPECT_THAT(Only(host).values, HasSubstr("both have one /dev/shm"));
  host.processes[1].launch.domain = 8;
  EXPECT_THAT(RulesOf(host), IsEmpty()) << "no finding across two domains";
}

TEST(Doctor, FindsAnInterfaceThatIsNotThere) {
  HostFacts host = HealthyHost();
  host.planned.launch.interface = "eth9";
  EXPECT_EQ(Only(host).rule, "interface_missing");
  EXPECT_THAT(Only(host).values, HasSubstr("only lo (127.0.0.1)"));
  host.planned.launch.interface = "lo";
  host.interfaces[0].up = false;
  EXPECT_EQ(Only(host).rule, "interface_missing");
  host.interfaces.clear();
  EXPECT_EQ(Only(host).rule, "interface_missing");
}

TEST(Doctor, FindsMulticastThatDoesNotComeBack) {
  HostFacts host = HealthyHost();
  host.interfaces[0].echoes_multicast = false;
  EXPECT_EQ(Only(host).rule, "multicast_missing");
  EXPECT_EQ(Only(host).severity, qos::Severity::kError);
  host.planned.launch.discovery_servers = {{"192.0.2.1"}};
  EXPECT_THAT(RulesOf(host), IsEmpty()) << "a discovery server needs none";
  host.planned.launch.discovery_servers.clear();
  host.planned.profiles = SetWith(
      "<builtin><discovery_config><discoveryProtocol>CLIENT</discoveryProtocol>"
      "</discovery_config></builtin>",
      "", "", true);
  EXPECT_THAT(RulesOf(host), IsEmpty()) << "a discovery server needs none";
}

TEST(Doctor, FindsAnInterfaceThatSaysItCarriesNoMulticast) {
  HostFacts host = HealthyHost();
  host.interfaces.push_back(host.interfaces[0]);
  host.interfaces[1].name = "wlan0";
  host.interfaces[1].address = "192.0.2.2";
  host.interfaces[1].loopback = false;
  EXPECT_THAT(RulesOf(host), IsEmpty()) << "the other is meant";
  host.planned.launch.interface = "any";
  EXPECT_EQ(Only(host).rule, "multicast_missing");
  EXPECT_EQ(Only(host).severity, qos::Severity::kWarning);
}

TEST(Doctor, FindsAReceiveBufferThatTheKernelCutsShort) {
  HostFacts host = HealthyHost();
  host.planned.profiles = SetOf("<receiveBufferSize>1048576</receiveBufferSize>", "");
  host.receive_buffer_max = 212'992;
  EXPECT_THAT(RulesOf(host), IsEmpty()) << "enough for two";
  host.vehicles = 210;
  host.open_files_limit = 20'000;
  host.ports.reset();
  EXPECT_EQ(Only(host).rule, "receive_buffer_small");
  EXPECT_THAT(Only(host).remedy, HasSubstr("rmem_max=1048576"));
}

TEST(Doctor, FindsPortsThatSomebodyElseHolds) {
  HostFacts host = HealthyHost();
  host.ports->push_back(9170);
  EXPECT_EQ(Only(host).rule, "ports_taken");
  EXPECT_THAT(Only(host).values, HasSubstr("1 UDP port of it: 9170"));
  host.domains = {8};
  EXPECT_THAT(RulesOf(host), IsEmpty());
  host.domains = {7};
  host.processes[1].ports.reset();
  EXPECT_THAT(RulesOf(host), IsEmpty()) << "they may be those of the second vehicle";
}

// `fleetctl run` was called a stranger in its own fleet, and the remedy was to end it.
TEST(Doctor, TakesToolsThatJoinFleetsForNoStrangers) {
  HostFacts host = HealthyHost();
  host.ports->insert(host.ports->end(), {9170, 9171});
  host.tool_ports = {{9170}};
  EXPECT_THAT(Only(host).values, HasSubstr("1 UDP port of it: 9171"));
  host.tool_ports = {{9170, 9171}};
  EXPECT_THAT(RulesOf(host), IsEmpty());
  host.tool_ports.reset();
  EXPECT_THAT(RulesOf(host), IsEmpty()) << "which are theirs is not known";
}

TEST(Doctor, FindsTooFewParticipantIds) {
  HostFacts host = HealthyHost();
  host.planned.profiles =
      SetWith("<builtin><mutation_tries>40</mutation_tries></builtin>", "", "", true);
  host.vehicles = 39;  // with world and observer, less two that run, 39 are to come, and 38 free
  EXPECT_EQ(Only(host).rule, "participant_ids_short");
  EXPECT_THAT(Only(host).consequence, HasSubstr("The last 1 find no free port"));
  host.vehicles = 38;
  EXPECT_THAT(RulesOf(host), IsEmpty());
}

TEST(Doctor, FindsIdsWhosePortsAreTheNextDomains) {
  HostFacts host = HealthyHost();
  host.planned.profiles = SetWith("<builtin><mutation_tries>400</mutation_tries></builtin>");
  host.vehicles = 120;
  EXPECT_EQ(Only(host).rule, "ports_of_next_domain");
}

TEST(Doctor, FindsPortsThatTheSystemHandsOut) {
  HostFacts host = HealthyHost();
  host.ephemeral = PortRange{1024, 60999};
  EXPECT_EQ(Only(host).rule, "ephemeral_ports");
  host.reserved = {{9000, 9399}};
  EXPECT_THAT(RulesOf(host), IsEmpty());
}

TEST(Doctor, FindsFilesAndVariablesTheLibraryReadsByItself) {
  HostFacts host = HealthyHost();
  host.surroundings[0].folder_files.push_back("DEFAULT_FASTRTPS_PROFILES.xml");
  EXPECT_EQ(Only(host).rule, "default_profiles_file");
  EXPECT_EQ(Only(host).place.file, "/home/me/DEFAULT_FASTRTPS_PROFILES.xml");
  host = HealthyHost();
  host.surroundings[0].environment.push_back("ROS_DISCOVERY_SERVER=10.0.0.1");
  host.surroundings.push_back(host.surroundings[0]);
  host.surroundings[1].who = "vehicle 1 (pid 101)";
  EXPECT_EQ(Only(host).rule, "ignored_variable") << "reported of the first alone";
  EXPECT_THAT(Only(host).values, HasSubstr("of this shell"));
}

TEST(Doctor, FindsAClockThatIsSet) {
  HostFacts host = HealthyHost();
  host.clock.offsets_ns.push_back(-30'000'000);
  EXPECT_EQ(Only(host).rule, "clock_step");
  EXPECT_EQ(Only(host).severity, qos::Severity::kWarning);
  host.planned.profiles = SetOf("",
                                "<qos><lifespan><duration><sec>1</sec></duration></lifespan>"
                                "</qos>");
  EXPECT_EQ(Only(host).severity, qos::Severity::kError);
  host.clock.offsets_ns.clear();
  host.clock.synchronised = false;
  EXPECT_EQ(Only(host).rule, "clock_unsynchronised");
  host.planned.profiles = SetWith();
  EXPECT_THAT(RulesOf(host), IsEmpty()) << "without LIFESPAN nothing depends on it";
}

TEST(Doctor, FindsLowLimitsOnOpenFiles) {
  HostFacts host = HealthyHost();
  host.open_files_limit = 64;
  EXPECT_EQ(Only(host).rule, "descriptor_limit");
  host = HealthyHost();
  host.processes[1].open_files = 1000;
  EXPECT_EQ(Only(host).subject, "vehicle 2 (pid 102)");
  EXPECT_EQ(Only(host).severity, qos::Severity::kWarning);
}

TEST(Doctor, SaysErrorsFirst) {
  HostFacts host = HealthyHost();
  AddStaleSegment("fastrtps_00000000000000aa", &host.memory);
  host.open_files_limit = 64;
  EXPECT_THAT(RulesOf(host), ElementsAre("descriptor_limit", "memory_stale"));
}

}  // namespace
}  // namespace giveway::fleetctl
