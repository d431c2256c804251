// A report folder is one soak's.
#include "services/fleetctl/soak/verb/folder_lock.h"

#include <gmock/gmock.h>

#include <optional>

#include "services/config/problem.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/process/child_process.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway::fleetctl {
namespace {

TEST(FolderLock, KeepsAnotherSoakOutAsLongAsItLives) {
  const TempFolder folder;
  std::optional<FolderLock> first(std::in_place, folder.Path(), "--report");
  EXPECT_THROW(FolderLock(folder.Path(), "--resume"), InputError);
  EXPECT_NO_THROW(FolderLock(TempFolder().Path(), "--report"));
  first.reset();
  EXPECT_NO_THROW(FolderLock(folder.Path(), "--resume"));
}

TEST(FolderLock, NoChildHasIt) {
  const TempFolder folder;
  std::optional<FolderLock> lock(std::in_place, folder.Path(), "--report");
  ChildProcess child({"child", {"/bin/sh", "-c", "echo is there; exec tail -f /dev/null"}});
  while (child.IsRunning() && child.LastLines().empty()) child.Poll();
  lock.reset();
  EXPECT_NO_THROW(FolderLock(folder.Path(), "--report"));
  EXPECT_TRUE(child.IsRunning());
}

TEST(FolderLock, SaysWhereItCannotBe) {
  EXPECT_THROW(FolderLock("/nowhere/at/all", "--report"), OutputError);
}

}  // namespace
}  // namespace giveway::fleetctl
