#include "services/fleetctl/doctor/doctor_read.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "services/config/problem.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

constexpr const char* kUdp =
    "   sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout "
    "inode ref pointer drops\n"
    "  12: 0100007F:23C4 00000000:0000 07 00000000:00000000 00:00000000 00000000  1000        0 "
    "777 2 0000000000000000 0\n";
constexpr const char* kUdp6 =
    "  sl  local_address remote_address st tx_queue rx_queue tr tm->when retrnsmt uid timeout "
    "inode ref pointer drops\n"
    "  13: 00000000000000000000000000000000:1F90 00000000000000000000000000000000:0000 07 "
    "00000000:00000000 00:00000000 00000000 0 0 778 2 0000000000000000 0\n";

// A host in a folder, on which vehicle 42 runs.
class MadeHost : public testing::Test {
 protected:
  MadeHost() {
    std::string name = testing::TempDir() + "doctor_XXXXXX";
    folder_ = mkdtemp(name.data());
    folders_ = {folder_ / "proc", folder_ / "shm"};
    Write("shm/fastrtps_port9160", "x");
    Write("proc/sys/net/core/rmem_max", "212992\n");
    Write("proc/sys/net/ipv4/ip_local_port_range", "32768\t60999\n");
    Write("proc/sys/net/ipv4/ip_local_reserved_ports", "9000-9249,9500\n");
    Write("proc/net/udp", kUdp);
    Write("proc/net/udp6", kUdp6);
    Write("proc/self/limits", "Max open files            1024       4096       files     \n");
    Write("proc/42/cmdline", ZeroEnding({"giveway-vehicle", "--domain", "7", "--id", "3"}));
    Write("proc/42/environ", ZeroEnding({"HOME=/"}));
    Write("proc/42/maps", "");
    fs::create_directories(folder_ / "proc/42/fd");
    Write("work/DEFAULT_FASTRTPS_PROFILES.xml", "<dds/>");
    fs::create_symlink(folder_ / "work", folder_ / "proc/42/cwd");
    Write("set.xml",
          "<dds><profiles><participant profile_name=\"giveway_participant\"/></profiles></dds>");
    options_.qos = (folder_ / "set.xml").string();
  }
  ~MadeHost() override { fs::remove_all(folder_); }

  void Write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  static std::string ZeroEnding(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += word + '\0';
    return text;
  }
  HostFacts Read() const { return ReadHost(options_, folders_); }

  fs::path folder_;
  HostFolders folders_;
  DoctorOptions options_;
};

TEST_F(MadeHost, IsReadFactByFact) {
  const HostFacts host = Read();
  EXPECT_EQ(host.receive_buffer_max, 212'992);
  ASSERT_TRUE(host.ephemeral && host.ports && host.open_files_limit);
  EXPECT_EQ(host.ephemeral->first, 32768U);
  EXPECT_EQ(host.ephemeral->last, 60999U);
  ASSERT_THAT(host.reserved, SizeIs(2));
  EXPECT_EQ(host.reserved[0].last, 9249U);
  EXPECT_EQ(host.reserved[1].first, 9500U);
  EXPECT_EQ(host.reserved[1].last, 9500U);
  EXPECT_THAT(*host.ports, ElementsAre(8080, 9156));
  EXPECT_EQ(*host.open_files_limit, 1024U);
  ASSERT_THAT(host.processes, SizeIs(1));
  EXPECT_EQ(host.processes[0].pid, 42);
  EXPECT_THAT(host.domains, ElementsAre(7)) << "that of the vehicle";
  ASSERT_THAT(host.memory.files, SizeIs(1));
  EXPECT_TRUE(host.planned.profiles.has_value());
}

TEST_F(MadeHost, ShowsWhereItsProcessesRun) {
  const HostFacts host = Read();
  ASSERT_THAT(host.surroundings, SizeIs(2));
  EXPECT_EQ(host.surroundings[0].who, "this shell");
  EXPECT_EQ(host.surroundings[1].who, "vehicle 3 (pid 42)");
  EXPECT_EQ(host.surroundings[1].folder, (folder_ / "work").string());
  EXPECT_THAT(host.surroundings[1].folder_files, ElementsAre("DEFAULT_FASTRTPS_PROFILES.xml"));
  EXPECT_THAT(host.surroundings[1].environment, ElementsAre("HOME=/"));
}

TEST_F(MadeHost, SaysWhatCannotBeRead) {
  fs::remove(folder_ / "proc/sys/net/core/rmem_max");
  const HostFacts host = Read();
  EXPECT_FALSE(host.receive_buffer_max.has_value());
  EXPECT_THAT(host.not_known, Contains(HasSubstr("rmem_max: No such file")));
}

TEST_F(MadeHost, IsNotJudgedBySetsThatCannotBeRead) {
  options_.qos = "no_such_set";
  EXPECT_THROW(Read(), InputError);
  Write("bad.xml", "no xml");
  options_.qos = (folder_ / "bad.xml").string();
  EXPECT_THROW(Read(), InputError);
}

TEST_F(MadeHost, TakesTheDomainItIsTold) {
  options_.domain = 9;
  EXPECT_THAT(Read().domains, ElementsAre(9));
  options_.domain.reset();
  fs::remove_all(folder_ / "proc/42");
  EXPECT_THAT(Read().domains, ElementsAre(1)) << "the first, if no process runs";
}

}  // namespace
}  // namespace giveway::fleetctl
