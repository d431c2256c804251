#include <gmock/gmock.h>

#include "services/app/restart.h"
#include "services/app/text_file.h"

namespace giveway::app {
namespace {

using ::testing::ElementsAre;

TEST(Restart, HandsOnSessionAndOrder) {
  const Resumed resumed{{1, 0xdeadbeef, 0, 0xffffffff}, 0x0123456789abcdefULL};
  EXPECT_EQ(ParseResumed(ToText(resumed)), resumed);
}

TEST(Restart, RefusesAWordThatIsNoneOfItsOwn) {
  const std::string good = ToText({{1, 2, 3, 4}, 5});
  ASSERT_TRUE(ParseResumed(good));
  for (const std::string& bad :
       {std::string(), std::string("1-2-3-4-5"), good + "0", good.substr(1), "x" + good.substr(1),
        good + "-", good.substr(0, 26)}) {
    EXPECT_FALSE(ParseResumed(bad)) << bad;
  }
}

TEST(Restart, PutsTheNewFlagsInPlaceOfTheOld) {
  EXPECT_THAT(ArgumentsWith({"vehicle", "--qos", "a.xml", "--lockstep", "--id=3", "--seed", "1"},
                            {{"--qos", "b.xml"}, {"--id", "4"}, {"--resume", "word"}}),
              ElementsAre("vehicle", "--lockstep", "--seed", "1", "--id", "4", "--qos", "b.xml",
                          "--resume", "word"));
}

TEST(Restart, FindsATextThatItHoldsAndItsName) {
  const std::string path = HoldText("mine.xml", "<dds/>");
  EXPECT_EQ(ReadBytes(path), "<dds/>");
  EXPECT_EQ(NameOf(path), "mine.xml");
  LetGo(path);  // only the next process image is without it
  EXPECT_EQ(ReadBytes(path), "<dds/>");
  EXPECT_EQ(NameOf(HoldText(std::string(300, 'x'), "")), std::string(200, 'x'));
}

TEST(Restart, NamesAFileByItsLastPart) { EXPECT_EQ(NameOf("/somewhere/mine.xml"), "mine.xml"); }

}  // namespace
}  // namespace giveway::app
