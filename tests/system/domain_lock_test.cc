#include "services/fleetctl/process/domain_lock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <memory>
#include <vector>

namespace giveway::fleetctl {
namespace {

// Other programs on this machine must not affect these tests.
bool Quiet(std::uint32_t) { return false; }

class DomainLockTest : public testing::Test {
 protected:
  DomainLockTest() {
    folder_ = testing::TempDir() + "domain_lock_" + std::to_string(::getpid());
    std::filesystem::create_directories(folder_);
  }
  ~DomainLockTest() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

TEST_F(DomainLockTest, EachRunTakesTheNextFreeDomain) {
  const DomainLock first(std::nullopt, folder_, Quiet);
  const DomainLock second(std::nullopt, folder_, Quiet);
  EXPECT_EQ(first.Domain(), 1U);
  EXPECT_EQ(second.Domain(), 2U);
}

TEST_F(DomainLockTest, DomainIsFreeAgainOnceItsRunIsOver) {
  { const DomainLock over(std::nullopt, folder_, Quiet); }
  EXPECT_EQ(DomainLock(std::nullopt, folder_, Quiet).Domain(), 1U);
}

TEST_F(DomainLockTest, WantedDomainThatIsTakenIsRefusedWithARemedy) {
  const DomainLock taken(42, folder_, Quiet);
  try {
    const DomainLock again(42, folder_, Quiet);
    FAIL() << "both took domain 42";
  } catch (const DomainError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("domain 42 is taken"));
    EXPECT_THAT(error.what(), testing::HasSubstr("leave out --domain"));
  }
}

TEST_F(DomainLockTest, HundredthRunIsRefused) {
  std::vector<std::unique_ptr<DomainLock>> runs;
  for (int i = 0; i < 99; ++i) {
    runs.push_back(std::make_unique<DomainLock>(std::nullopt, folder_, Quiet));
  }
  EXPECT_EQ(runs.back()->Domain(), 99U);
  EXPECT_THROW(DomainLock(std::nullopt, folder_, Quiet), DomainError);
}

TEST_F(DomainLockTest, ChildThatInheritedTheLockKeepsTheDomainTaken) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  pid_t child = 0;
  {
    const DomainLock lock(std::nullopt, folder_, Quiet);
    child = ::fork();
    if (child == 0) {
      ::close(pipe[1]);
      char byte = 0;
      [[maybe_unused]] const ssize_t end = ::read(pipe[0], &byte, 1);
      ::_exit(0);
    }
  }
  EXPECT_EQ(DomainLock(std::nullopt, folder_, Quiet).Domain(), 2U);
  ::close(pipe[1]);
  ::waitpid(child, nullptr, 0);
  ::close(pipe[0]);
  EXPECT_EQ(DomainLock(std::nullopt, folder_, Quiet).Domain(), 1U);
}

TEST_F(DomainLockTest, OtherUsersCanReadTheLockFileWhateverTheUmask) {
  const mode_t before = ::umask(077);
  const DomainLock lock(7, folder_, Quiet);
  ::umask(before);
  struct stat facts {};
  ASSERT_EQ(::stat((folder_ / "giveway-domain-7.lock").c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 0777U, 0644U);
}

// Regression: a fleet in a chroot held domain 1 by a lock file that no other could see; both runs
// were corrupted.
TEST_F(DomainLockTest, DomainWithoutALockButWithAParticipantIsPassedOver) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in loopback{};
  loopback.sin_family = AF_INET;
  loopback.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  loopback.sin_port = htons(7410 + 250 * 98 + 2);  // the second participant of domain 98
  const int bound = ::bind(socket, reinterpret_cast<const sockaddr*>(&loopback), sizeof loopback);
  EXPECT_TRUE(bound == 0 || errno == EADDRINUSE);
  EXPECT_THROW(DomainLock(98, folder_, IsSpokenIn), DomainError);
  ::close(socket);
}

TEST_F(DomainLockTest, FolderThatCannotBeUsedIsNamed) {
  try {
    const DomainLock lock(std::nullopt, folder_ / "absent", Quiet);
    FAIL() << "locked a domain nowhere";
  } catch (const DomainError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("absent"));
  }
}

}  // namespace
}  // namespace giveway::fleetctl
