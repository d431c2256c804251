#include "services/runtime/restart.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "services/config/text_file.h"
#include "tests/support/no_descriptors.h"

namespace giveway {
namespace {

using ::testing::ElementsAre;

TEST(Restart, PutsTheNewFlagsInPlaceOfTheOld) {
  EXPECT_THAT(ArgumentsWith({"vehicle", "--qos", "a.xml", "--lockstep", "--id=3", "--seed", "1"},
                            {{"--qos", "b.xml"}, {"--id", "4"}, {"--resume", "word"}}),
              ElementsAre("vehicle", "--lockstep", "--seed", "1", "--id", "4", "--qos", "b.xml",
                          "--resume", "word"));
}

TEST(Restart, LeavesAFlagWithoutAValueOut) {
  EXPECT_THAT(ArgumentsWith({"vehicle", "--resume", "word", "--lockstep"}, {{"--resume", ""}}),
              ElementsAre("vehicle", "--lockstep"));
}

TEST(Restart, FindsATextThatItHoldsAndItsName) {
  const std::string path = HoldText("mine.xml", "<dds/>");
  EXPECT_EQ(ReadBytes(path), "<dds/>");
  EXPECT_EQ(NameOf(path), "mine.xml");
  LetGo(path);  // only the next process image is without it
  EXPECT_EQ(ReadBytes(path), "<dds/>");
  EXPECT_EQ(NameOf(HoldText(std::string(300, 'x'), "")), std::string(200, 'x'));
}

// Issue 21, number 11: three sockets of the library were left open at every restart.
TEST(Restart, LeavesOnlyHeldTextsOpenToTheNextProcessImage) {
  const int other = open("/dev/null", O_RDONLY);
  const std::string held = HoldText("mine.xml", "<dds/>");
  LeaveOpenOnlyHeld();
  const int descriptor = std::stoi(held.substr(held.rfind('/') + 1));
  EXPECT_EQ(fcntl(other, F_GETFD) & FD_CLOEXEC, FD_CLOEXEC);
  EXPECT_EQ(fcntl(descriptor, F_GETFD) & FD_CLOEXEC, 0);
  EXPECT_EQ(fcntl(STDERR_FILENO, F_GETFD) & FD_CLOEXEC, 0);
  close(other);
}

// Regression: without a descriptor left a service that was to restart itself ended.
TEST(Restart, LeavesTheFlagOfATextThatItCannotHoldAsItIs) {
  if (!test::NoDescriptors::kErrorsCanBeThrown) GTEST_SKIP() << "the sanitizer needs descriptors";
  const std::vector<std::string> before = OwnArguments();
  NewFlags flags{{"--resume", ""}};
  std::vector<std::string> arguments;
  {
    const test::NoDescriptors none;
    EXPECT_FALSE(HoldTextFor("--qos", "mine.xml", "<dds/>", &flags));
    EXPECT_FALSE(HoldTextFor("--resume", "resume", "word", &flags));
    arguments = OwnArguments();
  }
  EXPECT_EQ(flags, (NewFlags{{"--resume", ""}}));
  EXPECT_EQ(arguments, before) << "what it restarts with";
  EXPECT_FALSE(arguments.empty());
  EXPECT_TRUE(HoldTextFor("--resume", "resume", "word", &flags));
  EXPECT_EQ(ReadBytes(flags["--resume"]), "word");
}

// Regression: the same, of one that has the profiles of an earlier restart and has read them.
TEST(Restart, HoldsATextAgainThatItHasLetGo) {
  const std::string held = HoldText("mine.xml", "<dds/>");
  const int descriptor = std::stoi(held.substr(held.rfind('/') + 1));
  LetGo(held);
  EXPECT_EQ(fcntl(descriptor, F_GETFD) & FD_CLOEXEC, FD_CLOEXEC);
  HoldAgain(held);
  EXPECT_EQ(fcntl(descriptor, F_GETFD) & FD_CLOEXEC, 0);
}

TEST(Restart, NamesAFileByItsLastPart) { EXPECT_EQ(NameOf("/somewhere/mine.xml"), "mine.xml"); }

}  // namespace
}  // namespace giveway
