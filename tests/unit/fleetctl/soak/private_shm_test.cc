#include "services/fleetctl/soak/host_faults/private_shm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

class PrivateShmTest : public ::testing::Test {
 protected:
  PrivateShmTest() { fs::create_directories(folder_); }
  ~PrivateShmTest() override { fs::remove_all(folder_); }

  void Put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_))
      names.push_back(entry.path().filename());
    return names;
  }

  fs::path folder_ =
      fs::temp_directory_path() / ("giveway_shm_" + std::to_string(::getpid()) +
                                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
  PrivateShm shm_{folder_};
};

TEST_F(PrivateShmTest, DeletesEveryFile) {
  Put("fastrtps_0123456789abcdef", "segment");
  Put("fastrtps_port7411", "port");
  EXPECT_EQ(shm_.DeleteAll(), 2U);
  EXPECT_THAT(Names(), testing::IsEmpty());
}

TEST_F(PrivateShmTest, LeavesCopiesOfSegmentsAndTakesThemAwayAgain) {
  Put("fastrtps_0123456789abcdef", "segment");
  Put("fastrtps_0123456789abcdef_el", "");
  Put("fastrtps_port7411", "port");
  EXPECT_EQ(shm_.LeaveOver(3), 3U);
  EXPECT_THAT(Names(), testing::SizeIs(6));
  EXPECT_EQ(fs::file_size(folder_ / "fastrtps_dead000000000002"), 7U);
  shm_.RemoveLeftOver();
  EXPECT_THAT(Names(), testing::SizeIs(3));
  EXPECT_TRUE(fs::exists(folder_ / "fastrtps_0123456789abcdef"));
}

TEST_F(PrivateShmTest, LeavesNothingOverWhereNoSegmentIs) {
  Put("fastrtps_port7411", "port");
  EXPECT_EQ(shm_.LeaveOver(3), 0U);
}

}  // namespace
}  // namespace giveway::fleetctl
