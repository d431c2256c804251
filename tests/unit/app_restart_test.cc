#include <fcntl.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <limits>
#include <string>
#include <vector>

#include "services/app/restart.h"
#include "services/app/text_file.h"

namespace giveway::app {
namespace {

using ::testing::ElementsAre;

Resumed Sample() {
  return {.session = {1, 0xdeadbeef, 0, 0xffffffff},
          .order = 0x0123456789abcdefULL,
          .handover = Handover{.epoch = WorldEpoch{7},
                               .tick = Tick{8},
                               .counted = {-1.5, 1e3 / 3},
                               .world_from_body = {{-0.1, 2e-300}, 3},
                               .covariance = {.xx_m2 = 0.25, .xy_m2 = -0.125, .yy_m2 = 0.5},
                               .task = {3, 400}}};
}

TEST(Restart, HandsOnWhoItIsWhereItIsAndWhatItWasDoing) {
  EXPECT_EQ(ResumedFrom(ToBytes(Sample())), Sample());
  Resumed without = Sample();
  without.handover.reset();
  EXPECT_EQ(ResumedFrom(ToBytes(without)), without);
}

TEST(Restart, RefusesBytesThatAreNoneOfItsOwn) {
  const std::string good = ToBytes(Sample());
  std::vector<std::string> bad{"",
                               "giveway-resume-1\n",
                               "x" + good,
                               good + "x",
                               good + good,
                               good.substr(1),
                               std::string(1U << 20U, 'x')};
  for (std::size_t i = 0; i < good.size(); ++i) {
    bad.push_back(good.substr(0, i));
    bad.push_back(good);
    bad.back()[i] = static_cast<char>(bad.back()[i] ^ 0x10);
  }
  for (const std::string& bytes : bad) EXPECT_FALSE(ResumedFrom(bytes)) << bytes;
}

TEST(Restart, RefusesWhatNoBrainCanGoOnFrom) {
  Resumed resumed = Sample();
  resumed.handover->world_from_body.position_world.x = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(ResumedFrom(ToBytes(resumed)));
  resumed = Sample();
  resumed.handover->covariance.hh_rad2 = -1;
  EXPECT_FALSE(ResumedFrom(ToBytes(resumed)));
}

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
}  // namespace giveway::app
