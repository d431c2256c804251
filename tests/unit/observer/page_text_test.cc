#include "services/observer/page/page_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace giveway {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(PageText, IsOneFileOfAtMost300kBWithoutOutsideResources) {
  const std::string page = PageText();
  EXPECT_LE(page.size(), 300'000U);
  EXPECT_THAT(page, HasSubstr("EventSource"));
  EXPECT_THAT(page, HasSubstr("--cooperative"));
  EXPECT_THAT(page, Not(HasSubstr("http://")));
  EXPECT_THAT(page, Not(HasSubstr("https://")));
  EXPECT_THAT(page, Not(HasSubstr("/*scripts*/")));
}

TEST(PageText, ARunWithinItCannotEndItsElement) {
  const std::string page = PageWithRun("{\"text\":\"</script><script>x\"}");
  EXPECT_THAT(page, HasSubstr("\\u003c/script>\\u003cscript>x"));
  EXPECT_THAT(page, Not(HasSubstr("</script><script>x")));
}

}  // namespace
}  // namespace giveway
