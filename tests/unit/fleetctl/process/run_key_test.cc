// Where the key of a fleet is found by an account with another environment than the run.
#include "services/fleetctl/process/run_key.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "services/auth/admin_key.h"
#include "services/fleetctl/process/domain_lock.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

bool IsSpokenInByNobody(std::uint32_t /*domain*/) { return false; }

// XDG_RUNTIME_DIR of the test's own, and a domain that is taken.
class RunKeyTest : public ::testing::Test {
 protected:
  RunKeyTest() {
    char name[] = "/tmp/giveway_run_key_XXXXXX";
    folder_ = mkdtemp(name);
    const char* const before = std::getenv("XDG_RUNTIME_DIR");
    if (before != nullptr) before_ = before;
  }
  ~RunKeyTest() override {
    if (before_) {
      setenv("XDG_RUNTIME_DIR", before_->c_str(), 1);
    } else {
      unsetenv("XDG_RUNTIME_DIR");
    }
    fs::remove_all(folder_);
  }
  void HaveRuntimeFolder() { setenv("XDG_RUNTIME_DIR", folder_.c_str(), 1); }
  std::uint32_t Domain() const { return lock_.Domain(); }

 private:
  fs::path folder_;
  std::optional<std::string> before_;
  DomainLock lock_{std::nullopt, P_tmpdir, IsSpokenInByNobody};
};

TEST_F(RunKeyTest, IsFoundByWhoHasARuntimeFolderThatTheRunDidNotHave) {
  unsetenv("XDG_RUNTIME_DIR");
  std::string file;
  {
    const RunKey key("", Domain());
    file = key.File();
    HaveRuntimeFolder();
    EXPECT_EQ(KeyToOrderWith("", Domain()), auth::ReadAdminKey(file));
  }
  EXPECT_FALSE(fs::exists(file));
  EXPECT_EQ(KeyToOrderWith("", Domain()), "");
}

TEST_F(RunKeyTest, TheNewestIsTakenWhereARunThatWasKilledLeftOne) {
  unsetenv("XDG_RUNTIME_DIR");
  const RunKey old("", Domain());
  fs::last_write_time(old.File(), fs::last_write_time(old.File()) - std::chrono::hours(1));
  HaveRuntimeFolder();
  const RunKey key("", Domain());
  ASSERT_NE(key.File(), old.File());
  EXPECT_EQ(KeyToOrderWith("", Domain()), auth::ReadAdminKey(key.File()));
  unsetenv("XDG_RUNTIME_DIR");
}

}  // namespace
}  // namespace giveway::fleetctl
