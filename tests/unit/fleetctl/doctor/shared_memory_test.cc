#include "services/fleetctl/doctor/shared_memory.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <semaphore.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "services/fleetctl/doctor/memory_read.h"
#include "services/fleetctl/doctor/memory_removal.h"
#include "services/fleetctl/process/file_descriptor.h"
#include "tests/unit/fleetctl/doctor/doctor_hosts.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;
using testing::Each;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::UnorderedElementsAre;

constexpr const char* kSegment = "fastrtps_0123456789abcdef";

std::vector<std::pair<std::string, MemoryState>> States(const SharedMemory& memory) {
  std::vector<std::pair<std::string, MemoryState>> states;
  for (const MemoryGroup& group : GroupsOf(memory)) states.emplace_back(group.body, group.state);
  return states;
}

TEST(SharedMemory, KnowsWhichFilesBelongTogether) {
  EXPECT_EQ(BodyOf("fastrtps_port7410"), "fastrtps_port7410");
  EXPECT_EQ(BodyOf("fastrtps_port7410_el"), "fastrtps_port7410");
  EXPECT_EQ(BodyOf("fastrtps_port7410_sl"), "fastrtps_port7410");
  EXPECT_EQ(BodyOf("sem.fastrtps_port7410_mutex"), "fastrtps_port7410");
  EXPECT_EQ(BodyOf("sem.fastdds_port7410_mutex"), "fastdds_port7410");
  EXPECT_EQ(BodyOf("fast_datasharing_01.0f_0.0.1.3"), "fast_datasharing_01.0f_0.0.1.3");
  for (const char* other : {"sem.other_mutex", "pulse-shm-1", "fastrtps", "sem.", ""}) {
    EXPECT_EQ(BodyOf(other), "") << other;
  }
}

TEST(SharedMemory, TellsByLockAndUsersWhetherAnOwnerLives) {
  SharedMemory memory;
  AddSegment("fastrtps_1", &memory);
  AddStaleSegment("fastrtps_2", &memory);
  AddStaleSegment("fastrtps_3", &memory);
  memory.files.back().locked = true;
  AddStaleSegment("fastrtps_4", &memory);
  memory.files.back().users = {7};
  memory.files.push_back(FileNamed("fastrtps_port1"));
  EXPECT_THAT(States(memory), ElementsAre(std::pair("fastrtps_1", MemoryState::kInUse),
                                          std::pair("fastrtps_2", MemoryState::kStale),
                                          std::pair("fastrtps_3", MemoryState::kInUse),
                                          std::pair("fastrtps_4", MemoryState::kInUse),
                                          std::pair("fastrtps_port1", MemoryState::kOrphaned)));
}

TEST(SharedMemory, DoesNotKnowWhatAnUnseenProcessCouldUse) {
  SharedMemory memory;
  memory.files = {FileNamed("fastrtps_port1")};
  memory.unseen = {{50, 2000}};
  EXPECT_EQ(GroupsOf(memory)[0].state, MemoryState::kOrphaned) << "that user cannot open it";
  for (const std::uint32_t user : {0U, 1000U}) {
    memory.unseen = {{50, user}};
    EXPECT_EQ(GroupsOf(memory)[0].state, MemoryState::kNotKnown) << user;
  }
  memory.unseen = {{50, 2000}};
  memory.files[0].mode = 0666;
  EXPECT_EQ(GroupsOf(memory)[0].state, MemoryState::kNotKnown);
  memory.files[0].held = false;
  EXPECT_EQ(GroupsOf(memory)[0].state, MemoryState::kOrphaned) << "the kernel knows";
  memory.files[0].held = true;
  EXPECT_EQ(GroupsOf(memory)[0].state, MemoryState::kInUse);
}

// A /dev/shm and a /proc with one process, 42, that uses nothing yet.
class MadeMemory : public testing::Test {
 protected:
  MadeMemory() {
    // Where it is used: a layered file system does not know what is mapped.
    const bool there = ::access("/dev/shm", W_OK) == 0;
    std::string name = (there ? "/dev/shm/" : testing::TempDir()) + "shared_memory_XXXXXX";
    folder_ = mkdtemp(name.data());
    fs::create_directories(shm());
    fs::create_directories(proc() / "42/fd");
    Write(proc() / "42/maps", "");
    Write(proc() / "42/cmdline", std::string("giveway-vehicle\0", 16));
    Write(proc() / "uptime", "1 1\n");
    user_ = ::geteuid();
  }
  ~MadeMemory() override { fs::remove_all(folder_); }

  fs::path shm() const { return folder_ / "shm"; }
  fs::path proc() const { return folder_ / "proc"; }
  static void Write(const fs::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
  }
  void Make(const std::vector<std::string>& names) const {
    for (const std::string& name : names) {
      Write(shm() / name, PartOf(name) == MemoryPart::kBody ? std::string(5000, 'x') : "");
      ::chmod((shm() / name).c_str(), 0644);
    }
  }
  void Map(const std::string& name) const {
    struct stat found {};
    ASSERT_EQ(::stat((shm() / name).c_str(), &found), 0);
    char line[200];
    std::snprintf(line, sizeof line, "7f00-7f10 rw-s 00000000 %02x:%02x %llu  /dev/shm/x\n",
                  major(found.st_dev), minor(found.st_dev),
                  static_cast<unsigned long long>(found.st_ino));
    Write(proc() / "42/maps", "5500-5510 r-xp 00000000 fe:00 12 /bin/x\n" + std::string(line));
  }
  SharedMemory Read() const { return ReadSharedMemory(shm(), proc()); }
  std::vector<Removal> Fix(const SharedMemory& memory) const { return RemoveGone(memory, user_); }
  std::vector<std::string> Left() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(shm()))
      names.push_back(entry.path().filename());
    return names;
  }

  fs::path folder_;
  std::uint32_t user_ = 0;
};

TEST_F(MadeMemory, IsReadWithSizesLocksAndUsers) {
  Make({kSegment, "fastrtps_0123456789abcdef_el", "fastrtps_port9160", "fastrtps_port9160_sl",
        "sem.fastrtps_port9160_mutex", "somebody_elses"});
  const FileDescriptor lock(::open((shm() / "fastrtps_port9160_sl").c_str(), O_RDONLY));
  ASSERT_EQ(::flock(lock.Get(), LOCK_SH), 0);
  Map(kSegment);
  fs::create_symlink(shm() / "sem.fastrtps_port9160_mutex", proc() / "42/fd/9");
  const SharedMemory memory = Read();
  ASSERT_THAT(memory.files, SizeIs(5));
  EXPECT_GT(memory.total_bytes, 0U);
  EXPECT_THAT(memory.unseen, IsEmpty());
  EXPECT_EQ(memory.files[0].name, kSegment);
  EXPECT_GE(memory.files[0].bytes, 4096U);
  EXPECT_EQ(memory.files[0].user, user_);
  EXPECT_THAT(memory.files[0].users, ElementsAre(42));
  EXPECT_EQ(memory.files[1].held, false);
  EXPECT_EQ(memory.files[3].held, true) << "a process that holds a lock has it open";
  EXPECT_THAT(memory.files[4].users, ElementsAre(42));
}

TEST_F(MadeMemory, LosesWhatNobodyUsesAndKeepsTheRest) {
  Make({kSegment, "fastrtps_0123456789abcdef_el", "fastrtps_port9160", "fastrtps_port9160_el",
        "sem.fastrtps_port9160_mutex", "fastrtps_port9162", "fastrtps_port9162_el",
        "somebody_elses"});
  const FileDescriptor lock(::open((shm() / "fastrtps_port9162_el").c_str(), O_RDONLY));
  ASSERT_EQ(::flock(lock.Get(), LOCK_EX), 0);
  Map(kSegment);
  const std::vector<Removal> removals = Fix(Read());
  EXPECT_THAT(removals, SizeIs(3));
  EXPECT_THAT(removals, Each(Field(&Removal::left, "")));
  EXPECT_THAT(Left(),
              UnorderedElementsAre(kSegment, "fastrtps_0123456789abcdef_el", "fastrtps_port9162",
                                   "fastrtps_port9162_el", "somebody_elses"));
}

TEST_F(MadeMemory, KeepsWhatIsUsedAgainSinceItWasRead) {
  Make({kSegment, "fastrtps_0123456789abcdef_el", "fastrtps_port9160", "fastrtps_port9162"});
  const SharedMemory before = Read();
  EXPECT_THAT(GroupsOf(before), Each(testing::Truly(std::mem_fn(&MemoryGroup::IsGone))));
  const FileDescriptor again(::open((shm() / kSegment).c_str(), O_RDWR));
  fs::rename(shm() / "fastrtps_port9160", shm() / "old");
  Make({"fastrtps_port9160"});
  fs::remove(shm() / "fastrtps_port9162");
  EXPECT_THAT(Fix(before),
              UnorderedElementsAre(Removal{shm() / kSegment, "is used again"},
                                   Removal{shm() / "fastrtps_0123456789abcdef_el", "is used again"},
                                   Removal{shm() / "fastrtps_port9160", "was replaced meanwhile"},
                                   Field(&Removal::left, testing::Ne(""))));
  EXPECT_THAT(Left(), SizeIs(4));
}

TEST_F(MadeMemory, KeepsWhatIsMappedByAProcessThatCannotBeSeen) {
  Make({"fastrtps_port9160"});
  void* mapped = MAP_FAILED;
  {
    const FileDescriptor file(::open((shm() / "fastrtps_port9160").c_str(), O_RDWR));
    mapped = ::mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, file.Get(), 0);
  }
  ASSERT_NE(mapped, MAP_FAILED);
  const SharedMemory memory = Read();
  EXPECT_EQ(memory.files[0].held, true);
  EXPECT_THAT(memory.files[0].users, IsEmpty());
  EXPECT_THAT(Fix(memory), IsEmpty()) << "it is in use: no finding";
  EXPECT_THAT(Left(), SizeIs(1));
  ::munmap(mapped, 4096);
  EXPECT_THAT(Fix(Read()), ElementsAre(Removal{shm() / "fastrtps_port9160", ""}));
}

TEST_F(MadeMemory, KeepsWhatMayNotBeAsked) {
  Make({"fastrtps_port9160"});
  SharedMemory memory = Read();
  memory.files[0].held.reset();
  memory.unseen = {{50, 0}};
  EXPECT_THAT(Fix(memory), ElementsAre(Field(&Removal::left, HasSubstr("only its owner"))));
  memory.files[0].held = false;
  memory.files[0].user = user_ + 1;
  EXPECT_THAT(RemoveGone(memory, user_ + 2),
              ElementsAre(Field(&Removal::left, HasSubstr("only root may remove it"))));
  EXPECT_THAT(Left(), SizeIs(1));
  EXPECT_THAT(RemoveGone(memory, 0), ElementsAre(Field(&Removal::left, "")));
}

TEST_F(MadeMemory, ShowsWhoMayNotBeLookedInto) {
  Make({"fastrtps_port9160"});
  EXPECT_THAT(Read().unseen, IsEmpty());
  fs::remove_all(proc() / "42/fd");  // as good as unreadable
  ASSERT_THAT(Read().unseen, SizeIs(1));
  EXPECT_EQ(Read().unseen[0].pid, 42);
  EXPECT_EQ(Read().unseen[0].user, user_);
}

TEST_F(MadeMemory, LetsGoOfTheMutexOfAPortThatStays) {
  Make({"fastrtps_port9160"});
  sem_t free_one{};
  ASSERT_EQ(::sem_init(&free_one, 1, 1), 0);
  const fs::path mutex = shm() / "sem.fastrtps_port9160_mutex";
  Write(mutex, std::string(reinterpret_cast<const char*>(&free_one), sizeof free_one));
  const SharedMemory before = Read();
  const FileDescriptor again(::open((shm() / "fastrtps_port9160").c_str(), O_RDWR));
  EXPECT_THAT(Fix(before), Each(Field(&Removal::left, "is used again")));
  sem_t after{};
  std::ifstream(mutex, std::ios::binary).read(reinterpret_cast<char*>(&after), sizeof after);
  int value = 0;
  ASSERT_EQ(::sem_getvalue(&after, &value), 0);
  EXPECT_EQ(value, 1);
}

}  // namespace
}  // namespace giveway::fleetctl
