#include "services/auth/admin_key.h"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace giveway::auth {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class AdminKey : public ::testing::Test {
 protected:
  AdminKey() { std::filesystem::create_directory(folder_); }
  ~AdminKey() override { std::filesystem::remove_all(folder_); }
  std::string With(const std::string& text) {
    const std::string file = folder_ / "key";
    std::ofstream(file) << text;
    return file;
  }
  std::string WhyNot(const std::string& file) {
    try {
      ReadAdminKey(file);
      return "";
    } catch (const KeyError& error) {
      return error.what();
    }
  }
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("giveway-key-" + std::to_string(getpid()));
};

TEST_F(AdminKey, IsTheFileWithoutWhiteSpaceAtItsEnd) {
  EXPECT_EQ(ReadAdminKey(With("0123456789abcdef \r\n\n")), "0123456789abcdef");
}

TEST_F(AdminKey, TooShortTooLongOrMissingIsRefusedByName) {
  EXPECT_THAT(WhyNot(With("0123456789abcde\n")), HasSubstr("has 15 bytes, must have 16 to 4096"));
  EXPECT_THAT(WhyNot(With(std::string(5000, 'x'))),
              HasSubstr("has 5000 bytes, must have 16 to 4096"));
  EXPECT_THAT(WhyNot(With(std::string(10'000, 'x'))),
              HasSubstr("has 8192 or more bytes, must have 16 to 4096"));
  EXPECT_THAT(WhyNot(folder_ / "absent"),
              AllOf(HasSubstr("absent: cannot be read: No such file"), HasSubstr("openssl rand")));
  EXPECT_THAT(WhyNot(folder_), HasSubstr("is no regular file"));
}

// Regression: it was counted with its newline, and refused as one of 4096 bytes.
TEST_F(AdminKey, TheLongestMayEndInANewline) {
  const std::string longest(4096, 'x');
  EXPECT_EQ(ReadAdminKey(With(longest)), longest);
  EXPECT_EQ(ReadAdminKey(With(longest + "\n")), longest);
  EXPECT_THAT(WhyNot(With(longest + "x\n")), HasSubstr("has 4097 bytes, must have 16 to 4096"));
  // What follows the white space would make it another key.
  EXPECT_THAT(WhyNot(With(longest + std::string(4096, '\n') + "x")), HasSubstr("8192 or more"));
}

TEST_F(AdminKey, OneThatIsMadeIsOfThisUserAloneAndNeverTheSame) {
  const std::string file = folder_ / "made";
  MakeAdminKey(file);
  struct stat about {};
  ASSERT_EQ(stat(file.c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 0777U, 0600U);
  const std::string first = ReadAdminKey(file);
  EXPECT_EQ(first.size(), 64U);
  MakeAdminKey(file);
  EXPECT_NE(ReadAdminKey(file), first);
}

}  // namespace
}  // namespace giveway::auth
