#include "services/runtime/restart.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "services/config/text_file.h"

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

TEST(Restart, NamesAFileByItsLastPart) { EXPECT_EQ(NameOf("/somewhere/mine.xml"), "mine.xml"); }

}  // namespace
}  // namespace giveway
