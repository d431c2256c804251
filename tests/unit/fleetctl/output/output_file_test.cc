// What cannot be written now may be written later, or never: only the first is worth another try.
#include "services/fleetctl/output/output_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "tests/support/no_descriptors.h"
#include "tests/unit/config/scenario_files.h"

namespace giveway::fleetctl {
namespace {

using testing::HasSubstr;
using testing::Not;

OutputError ErrorOf(const std::function<void()>& write) {
  try {
    write();
  } catch (const OutputError& error) {
    return error;
  }
  return OutputError("nothing failed");
}

TEST(OutputFile, AFullDiskOrALimitMayPass) {
  const TempFolder folder;
  const OutputError full = ErrorOf([] { WriteFile("/dev/full", "text"); });
  EXPECT_TRUE(full.MayPass());
  EXPECT_THAT(full.what(), HasSubstr("No space left on device; see to that disk or limit"));
  const test::NoDescriptors none;
  EXPECT_TRUE(ErrorOf([&] { CheckWritable(folder.Path() + "/result.json"); }).MayPass());
  EXPECT_TRUE(ErrorOf([&] { CheckFolder(folder.Path() + "/results"); }).MayPass());
  EXPECT_TRUE(ErrorOf([&] { WriteFile(folder.Path() + "/result.json", "text"); }).MayPass());
}

TEST(OutputFile, APlaceThatIsNoneStaysSo) {
  const TempFolder folder;
  const std::string file = folder.Write("file", "text");
  for (const OutputError& error : {ErrorOf([&] { CheckWritable(folder.Path() + "/none/file"); }),
                                   ErrorOf([&] { CheckFolder(file + "/results"); })}) {
    EXPECT_FALSE(error.MayPass()) << error.what();
    EXPECT_THAT(error.what(), HasSubstr("; name a file in a folder that exists"));
    EXPECT_THAT(error.what(), Not(HasSubstr("nothing failed")));
  }
}

}  // namespace
}  // namespace giveway::fleetctl
