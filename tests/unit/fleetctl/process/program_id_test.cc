// The build id of a program, of the running one and of a file.
#include "services/fleetctl/process/program_id.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "tests/unit/config/scenario_files.h"

namespace giveway::fleetctl {
namespace {

TEST(ProgramId, OfTheRunningProgramIsThatOfItsFile) {
  const std::string id = ProgramId();
  EXPECT_THAT(id, ::testing::MatchesRegex("[0-9a-f]{16,}"));
  EXPECT_EQ(ProgramIdOf(std::filesystem::read_symlink("/proc/self/exe")), id);
}

TEST(ProgramId, OfWhatIsNoProgramIsEmpty) {
  const TempFolder folder;
  EXPECT_EQ(ProgramIdOf(folder.Path() + "/absent"), "");
  for (const std::string text : {"", "#!/bin/sh",
                                 "\x7f"
                                 "ELF"}) {
    EXPECT_EQ(ProgramIdOf(folder.Write("file", text)), "") << text;
  }
}

}  // namespace
}  // namespace giveway::fleetctl
