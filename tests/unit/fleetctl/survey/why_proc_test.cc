#include "services/fleetctl/survey/why_proc.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>

#include "services/fleetctl/survey/other_fleets.h"
#include "services/fleetctl/survey/why_proc_text.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr const char* kTrie =
    "Main:\n"
    "  +-- 0.0.0.0/0 3 0 5\n"
    "     |-- 0.0.0.0\n"
    "        /0 universe UNICAST\n"
    "     |-- 127.0.0.0\n"
    "        /8 host LOCAL\n"
    "     |-- 127.0.0.1\n"
    "        /32 host LOCAL\n"
    "     |-- 127.255.255.255\n"
    "        /32 link BROADCAST\n"
    "     |-- 10.0.0.9\n"
    "        /32 host LOCAL\n"
    "     |-- 192.0.2.2\n"
    "        /32 host LOCAL\n"
    "Local:\n"
    "     |-- 192.0.2.2\n"
    "        /32 host LOCAL\n";
constexpr const char* kRoute =
    "Iface\tDestination\tGateway \tFlags\tRefCnt\tUse\tMetric\tMask\t\tMTU\tWindow\tIRTT\n"
    "eth0\t00000000\t010200C0\t0003\t0\t0\t0\t00000000\t0\t0\t0\n"
    "eth0\t000200C0\t00000000\t0001\t0\t0\t0\t00FFFFFF\t0\t0\t0\n"
    "veth1\t000200C0\t010200C0\t0003\t0\t0\t0\t80FFFFFF\t0\t0\t0\n"
    "veth1\t0000000A\t00000000\t0001\t0\t0\t0\t000000FF\t0\t0\t0\n";
constexpr const char* kDev =
    "Inter-|   Receive                                                |  Transmit\n"
    " face |bytes    packets errs drop fifo frame compressed multicast|bytes    packets\n"
    "    lo: 5167049396 16411653    0\n"
    "  eth0: 352998022    8423    0\n"
    " veth1:       0       0    0\n";
// Port 0x23c4 is 9156, of inode 777; 0x1f90 belongs to another process.
constexpr const char* kUdp =
    "   sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout "
    "inode ref pointer drops\n"
    "  12: 0100007F:23C4 00000000:0000 07 00000000:00000000 00:00000000 00000000  1000        0 "
    "777 2 0000000000000000 0\n"
    "  13: 00000000:1F90 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 "
    "778 2 0000000000000000 0\n";

// A /proc with one vehicle, 42, in a file system of its own.
class MadeProc : public testing::Test {
 protected:
  MadeProc() {
    std::string name = testing::TempDir() + "why_proc_XXXXXX";
    folder_ = mkdtemp(name.data());
    Write("stat", "cpu 1 2 3\nbtime 1000\n");
    Write("42/cmdline",
          Zeros({"/opt/bin/giveway-vehicle", "--scenario", "town", "--domain", "7", "--qos",
                 "mine.xml", "--id=3", "--partition-free", "--leave-out", "shared_memory"}));
    Write("42/environ", Zeros({"GIVEWAY_INTERFACE=eth0", "GIVEWAY_IMPAIR=loss=1", "HOME=/"}));
    Write("42/stat", "42 (a) vehicle) T 1 42 42 0 -1 0 0 0 0 0 0 0 0 0 20 0 7 0 500 0 0\n");
    Write("42/status", "Name:\tgiveway-vehicle\nNSpid:\t42\t5\n");
    Write("42/limits",
          "Limit                     Soft Limit           Hard Limit           Units\n"
          "Max open files            1024                 4096                 files\n");
    Write("42/net/fib_trie", kTrie);
    Write("42/net/route", kRoute);
    Write("42/net/dev", kDev);
    Write("42/net/udp", kUdp);
    for (const char* kind : {"net", "ipc", "mnt"}) {
      Link("42/ns/" + std::string(kind), std::string(kind) + ":[4026531840]");
    }
    Link("42/fd/0", "/dev/null");
    Link("42/fd/7", "socket:[777]");
    Write("root/dev/shm/x", "");
    Link("42/root", (folder_ / "root").string());
    Write("work/mine.xml",
          "<dds><profiles><participant profile_name=\"giveway_participant\"/></profiles></dds>");
    Link("42/cwd", (folder_ / "work").string());
    Write("43/cmdline", Zeros({"/bin/bash", "giveway-vehicle"}));
    Write("44/cmdline", Zeros({"giveway-world", "--domain", "8"}));
    Write("45/cmdline", "");
  }
  ~MadeProc() override { fs::remove_all(folder_); }

  void Write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  void Link(const std::string& name, const std::string& to) const {
    fs::create_directories((folder_ / name).parent_path());
    fs::create_symlink(to, folder_ / name);
  }
  static std::string Zeros(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += word + '\0';
    return text;
  }

  fs::path folder_;
};

TEST_F(MadeProc, ServicesAreFoundByTheirProgramAndNothingElseIs) {
  const auto members = FindFleet(folder_);
  ASSERT_EQ(members.size(), 2U);
  EXPECT_EQ(members[0].pid, 42);
  EXPECT_EQ(members[0].id, VehicleId{3});
  EXPECT_EQ(members[0].domain, 7U);
  EXPECT_FALSE(members[0].is_world);
  EXPECT_EQ(members[1].pid, 44);
  EXPECT_TRUE(members[1].is_world);
}

// Regression: three vehicles without --id were distinguished by discovery alone, and in containers,
// where all are process 1, not at all.
TEST_F(MadeProc, AVehicleIsKnownByTheIdThatTheWorldGaveIt) {
  for (const char* pid : {"51", "52"}) {
    Write(std::string(pid) + "/cmdline", Zeros({"giveway-vehicle", "--domain", "7"}));
    Write(std::string(pid) + "/status", "Name:\tgiveway-vehicle\nNSpid:\t51\t1\n");
    Link(std::string(pid) + "/ns/net", std::string("net:[40265319") + pid + "]");
    Link(std::string(pid) + "/fd/9", "memfd:giveway-identity (deleted)");
  }
  Write("51/fd/memfd:giveway-identity (deleted)",
        "vehicle 3\nparticipant 010f45d2a3b1000001000000\n");
  Write("52/fd/memfd:giveway-identity (deleted)", "vehicle 4\npart");  // being written
  const auto members = FindFleet(folder_);
  ASSERT_EQ(members.size(), 4U);
  EXPECT_EQ(members[2].id, VehicleId{3});
  EXPECT_EQ(members[2].network_namespace, 4026531951U);
  EXPECT_EQ(members[3].id, kNoVehicle);
  const auto situation = ReadSituation(folder_, 51);
  ASSERT_TRUE(situation);
  EXPECT_EQ(situation->launch.id, VehicleId{3});
  EXPECT_EQ(situation->participant, "010f45d2a3b1000001000000");
}

// A container engine's bridge without a container: the library's host id does not include it.
TEST_F(MadeProc, AnInterfaceWithoutCarrierHasNoAddressForTheLibrary) {
  const auto all = ReadSituation(folder_, 42)->addresses;
  ASSERT_TRUE(all && all->size() > 1);
  const NetworkAddress last = all->back();
  Write("root/sys/class/net/" + last.interface + "/carrier", "1\n");
  EXPECT_EQ(ReadSituation(folder_, 42)->addresses, all);
  Write("root/sys/class/net/" + last.interface + "/carrier", "0\n");
  const auto running = ReadSituation(folder_, 42)->addresses;
  ASSERT_TRUE(running);
  EXPECT_EQ(running->size(), all->size() - 1);
  EXPECT_EQ(std::ranges::find(*running, last), running->end());
}

TEST_F(MadeProc, WhatItWasToldIsOfTheCommandLineElseOfTheEnvironment) {
  const auto situation = ReadSituation(folder_, 42);
  ASSERT_TRUE(situation);
  const LaunchOptions& launch = situation->launch;
  EXPECT_EQ(launch.id, VehicleId{3});
  EXPECT_EQ(launch.domain, 7U);
  EXPECT_EQ(launch.interface, "eth0");
  EXPECT_TRUE(launch.partition_free);
  EXPECT_TRUE(launch.leaves_out_shared_memory);
  ASSERT_EQ(launch.impairment.rules.size(), 1U);
  EXPECT_EQ(launch.impairment.rules[0].loss, 1);
  EXPECT_EQ(launch.qos_file, (folder_ / "work/mine.xml").string());
  ASSERT_TRUE(situation->profiles);
  EXPECT_TRUE(ParticipantNumber(*situation, qos::Policy::kPortBase));
}

// Regression: they were left out, and a fleet that is found through them was judged as one that is
// found by multicast.
TEST_F(MadeProc, DiscoveryServersAreOfTheCommandLineElseOfTheEnvironment) {
  Write("42/environ", Zeros({"GIVEWAY_DISCOVERY_SERVER=192.0.2.1,192.0.2.3:7000"}));
  const auto situation = ReadSituation(folder_, 42);
  ASSERT_TRUE(situation);
  EXPECT_EQ(ToText(situation->launch.discovery_servers), "192.0.2.1:11811,192.0.2.3:7000");
  EXPECT_EQ(DiscoveryProtocol(*situation), qos::kClient);
  Write("44/cmdline", Zeros({"giveway-world", "--domain", "8", "--discovery-server", "a:b:c"}));
  const auto world = ReadSituation(folder_, 44);
  ASSERT_TRUE(world);
  EXPECT_TRUE(world->launch.discovery_servers.empty());
  EXPECT_THAT(world->not_known, Contains("discovery servers: a:b:c"));
}

TEST_F(MadeProc, ProfilesMayBeNamedAsAShippedSet) {
  Write("42/cmdline", Zeros({"/opt/bin/giveway-vehicle", "--domain", "7", "--qos", "radio"}));
  Write("42/environ", Zeros({"GIVEWAY_CONFIG_DIR=/etc/giveway"}));
  Write("root/etc/giveway/qos/radio.xml", "<dds><profiles/></dds>");
  const auto situation = ReadSituation(folder_, 42);
  ASSERT_TRUE(situation);
  EXPECT_EQ(situation->launch.qos_file, "/etc/giveway/qos/radio.xml");
  EXPECT_TRUE(situation->profiles);
}

// Regression: both were looked for in the folder, and not known.
TEST_F(MadeProc, AFolderWhereItRunsDoesNotHideWhatIsShippedUnderItsName) {
  Write("42/cmdline", Zeros({"/opt/bin/giveway-vehicle", "--domain", "7", "--qos", "radio",
                             "--scenario", "town"}));
  Write("42/environ", Zeros({"GIVEWAY_CONFIG_DIR=/etc/giveway"}));
  Write("root/etc/giveway/qos/radio.xml", "<dds><profiles/></dds>");
  Write("root/etc/giveway/scenarios/town.textproto", "no scenario");
  for (const char* const name : {"radio", "town"}) fs::create_directories(folder_ / "work" / name);
  const auto situation = ReadSituation(folder_, 42);
  ASSERT_TRUE(situation);
  EXPECT_EQ(situation->launch.qos_file, "/etc/giveway/qos/radio.xml");
  EXPECT_THAT(situation->not_known, Contains(HasSubstr("scenarios/town.textproto")));
}

// Regression: a switch with a value was taken for off, and by the process itself for on.
TEST_F(MadeProc, ASwitchMayHaveAValue) {
  const auto partition_free = [this](const std::vector<std::string>& flags) {
    std::vector<std::string> words{"giveway-vehicle", "--domain", "7"};
    words.insert(words.end(), flags.begin(), flags.end());
    Write("42/cmdline", Zeros(words));
    return ReadSituation(folder_, 42)->launch.partition_free;
  };
  EXPECT_TRUE(partition_free({"--partition-free"}));
  EXPECT_TRUE(partition_free({"--partition-free=true"}));
  EXPECT_FALSE(partition_free({"--partition-free", "--partition-free=0"}));
  Write("42/environ", Zeros({"GIVEWAY_PARTITION_FREE=1"}));
  EXPECT_TRUE(partition_free({}));
  EXPECT_FALSE(partition_free({"--partition-free=false"}));
}

TEST_F(MadeProc, WhatTheSystemGivesItIsReadFactByFact) {
  const auto situation = ReadSituation(folder_, 42);
  ASSERT_TRUE(situation);
  EXPECT_EQ(situation->state, 'T');
  EXPECT_EQ(situation->pid_inside, 5);
  EXPECT_EQ(situation->network_namespace, 4026531840U);
  EXPECT_EQ(situation->open_files, 2U);
  EXPECT_EQ(situation->open_files_limit, 1024U);
  EXPECT_EQ(situation->ports, std::vector<std::uint16_t>{9156});
  EXPECT_EQ(situation->environment.size(), 3U);
  struct stat memory {};
  ASSERT_EQ(::stat((folder_ / "root/dev/shm").c_str(), &memory), 0);
  EXPECT_EQ(situation->shared_memory, (FileIdentity{memory.st_dev, memory.st_ino}));
  EXPECT_THAT(AllowedAddresses(*situation),
              ElementsAre(NetworkAddress{"eth0", 0xc0000202, 0xffffff00}));
}

TEST_F(MadeProc, ProfilesWrittenAfterTheStartAreMarked) {
  // It started 1005 s after 1970, and the file is of today.
  EXPECT_TRUE(ReadSituation(folder_, 42)->profiles_changed);
  Write("stat", "btime 99999999999\n");
  EXPECT_FALSE(ReadSituation(folder_, 42)->profiles_changed);
}

TEST_F(MadeProc, WhatCannotBeReadIsNamedAndAbsent) {
  fs::remove(folder_ / "42/ns/net");
  fs::remove_all(folder_ / "42/net");
  fs::remove(folder_ / "42/stat");
  fs::remove(folder_ / "work/mine.xml");
  const auto situation = ReadSituation(folder_, 42);
  ASSERT_TRUE(situation);
  EXPECT_FALSE(situation->network_namespace);
  EXPECT_FALSE(situation->addresses);
  EXPECT_FALSE(situation->ports);
  EXPECT_FALSE(situation->state);
  EXPECT_FALSE(situation->profiles);
  for (const char* fact : {"network namespace: ", "addresses: ", "ports: ", "state: ",
                           "mine.xml: does not exist", "scenario town"}) {
    EXPECT_THAT(situation->not_known, Contains(HasSubstr(fact)));
  }
}

TEST_F(MadeProc, NoProcessOfAFleetIsNothing) {
  for (const int pid : {1, 43, 45}) EXPECT_FALSE(ReadSituation(folder_, pid)) << pid;
  EXPECT_THAT(FindFleet(folder_ / "nowhere"), IsEmpty());
}

TEST(ProcText, AddressesComeInTheOrderOfInterfacesWithTheirNetworks) {
  EXPECT_THAT(ParseAddresses(kTrie, kRoute, kDev),
              ElementsAre(NetworkAddress{"lo", 0x7f000001, 0xff000000},
                          NetworkAddress{"eth0", 0xc0000202, 0xffffff00},
                          NetworkAddress{"veth1", 0x0a000009, 0xff000000}));
}

TEST(ProcText, NonsenseIsNothing) {
  EXPECT_FALSE(ParseStat("42 (x"));
  EXPECT_FALSE(ParseStat("42 (x) S 1"));
  EXPECT_FALSE(ParseBracketed("net:[12", "net"));
  EXPECT_FALSE(ParseBracketed("mnt:[12]", "net"));
  EXPECT_FALSE(ParseOpenFilesLimit("Max open files            unlimited  unlimited files\n"));
  EXPECT_FALSE(ParseBootTime("cpu 1"));
  EXPECT_FALSE(ParseInnerPid(""));
  EXPECT_THAT(ParseUdp("1: nonsense\n  1: 0100007F:XYZ a b c d e f g 7\n"), IsEmpty());
  EXPECT_THAT(ParseAddresses("     |-- 300.0.0.1\n        /32 host LOCAL\n", "", ""), IsEmpty());
  EXPECT_THAT(ZeroEnded(""), IsEmpty());
}

// Regression: of two fleets in one domain number the one that could be received was taken without a
// warning.
TEST(OtherFleetsTest, AreNamedWithWhatChoosesThem) {
  std::vector<FleetMember> members;
  members.push_back({.pid = 1, .domain = 7, .interface = "127.0.0.1", .network_namespace = 100});
  members.push_back({.pid = 2, .domain = 7, .interface = "lo", .network_namespace = 100});
  EXPECT_THAT(OtherFleets(members, 7, "127.0.0.1", 100), IsEmpty());
  members.push_back({.pid = 3, .domain = 8, .interface = "eth0", .network_namespace = 100});
  members.push_back({.pid = 4, .domain = 7, .interface = "eth0", .network_namespace = 100});
  members.push_back({.pid = 5, .domain = 7, .interface = "127.0.0.1", .network_namespace = 200});
  members.push_back({.pid = 6, .domain = 7, .interface = "127.0.0.1", .network_namespace = 200});
  EXPECT_THAT(OtherFleets(members, 7, "127.0.0.1", 100),
              ElementsAre(AllOf(HasSubstr("interface eth0 (processes pid:4)"),
                                HasSubstr("choose it by --interface eth0")),
                          AllOf(HasSubstr("network namespace 200 (processes pid:5 pid:6)"),
                                HasSubstr("nsenter"))));
}

// Regression: the interface that another user wrote was printed as it is.
TEST(OtherFleetsTest, TheirInterfaceDoesNotCommandTheTerminal) {
  std::vector<FleetMember> members;
  members.push_back(
      {.pid = 1, .domain = 7, .interface = "\x1b[2J\xc2\x9b", .network_namespace = 100});
  EXPECT_THAT(OtherFleets(members, 7, "127.0.0.1", 100),
              ElementsAre(HasSubstr("choose it by --interface ?[2J?")));
}

}  // namespace
}  // namespace giveway::fleetctl
