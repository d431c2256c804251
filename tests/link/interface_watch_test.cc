// Which changes of interfaces leave a participant without reception. No interface is changed.
#include "services/link/fastdds/interface_watch.h"

#include <gmock/gmock.h>

#include "tests/support/no_descriptors.h"

namespace giveway::link {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

Interface Of(const std::string& name, const std::string& address, unsigned index) {
  return {.name = name, .address = address, .loopback = name == "lo", .index = index};
}

const Interface kLo = Of("lo", "127.0.0.1", 1);
const Interface kEth = Of("eth0", "172.18.0.3", 7);

TEST(InterfaceWatch, SaysNothingWhileAllAreThere) {
  for (const char* meant : {"any", "eth0", "172.18.0.3"}) {
    EXPECT_THAT(ChangeOf(meant, {kLo, kEth}, {kLo, kEth}), IsEmpty());
    EXPECT_THAT(ChangeOf(meant, {kLo, kEth}, {kLo, kEth, Of("eth1", "10.0.0.2", 9)}), IsEmpty());
  }
}

TEST(InterfaceWatch, WaitsWhileOneIsAway) {
  for (const char* meant : {"any", "eth0", "172.18.0.3"}) {
    EXPECT_THAT(ChangeOf(meant, {kLo, kEth}, {kLo}), IsEmpty()) << meant;
  }
}

TEST(InterfaceWatch, SeesOneThatCameBackOtherwise) {
  const Interface address = Of("eth0", "172.18.0.4", 7);
  const Interface device = Of("eth0", "172.18.0.3", 9);
  for (const char* meant : {"any", "eth0", "172.18.0.3"}) {
    EXPECT_THAT(ChangeOf(meant, {kLo, kEth}, {kLo, address}), HasSubstr("eth0 (172.18.0.4)"))
        << meant;
    EXPECT_THAT(ChangeOf(meant, {kLo, kEth}, {kLo, device}), HasSubstr("eth0")) << meant;
  }
  EXPECT_THAT(ChangeOf("any", {kLo, kEth}, {kLo, Of("eth1", "172.18.0.4", 9)}), HasSubstr("eth1"));
  EXPECT_THAT(ChangeOf("any", {kLo}, {kLo, kEth}), HasSubstr("was none"));
}

TEST(InterfaceWatch, WaitsForOneThatIsBackButNotUpYet) {
  Interface down = Of("eth0", "172.18.0.4", 9);
  down.up = false;
  for (const char* meant : {"any", "eth0", "172.18.0.3"}) {
    EXPECT_THAT(ChangeOf(meant, {kLo, kEth}, {kLo, down}), IsEmpty()) << meant;
  }
}

TEST(InterfaceWatch, KeepsToTheInterfaceThatIsMeant) {
  EXPECT_THAT(ChangeOf("lo", {kLo, kEth}, {kLo, Of("eth0", "172.18.0.4", 9)}), IsEmpty());
  EXPECT_THAT(ChangeOf("eth0", {kLo, kEth}, {kLo, Of("eth1", "10.0.0.2", 9)}), IsEmpty());
}

// Regression: one whose index could not be asked for was taken for another device.
TEST(InterfaceWatch, TakesAnIndexThatIsNotKnownForNoDifference) {
  const Interface unknown = Of("eth0", "172.18.0.3", 0);
  for (const char* meant : {"any", "eth0", "172.18.0.3"}) {
    EXPECT_THAT(ChangeOf(meant, {kLo, kEth}, {kLo, unknown}), IsEmpty()) << meant;
    EXPECT_THAT(ChangeOf(meant, {kLo, unknown}, {kLo, kEth}), IsEmpty()) << meant;
  }
}

// Regression: a service without a descriptor left ended, "cannot list the network interfaces".
TEST(InterfaceWatch, SaysNothingWhileTheInterfacesCannotBeListed) {
  const InterfaceWatch watch("any");
  std::string change = "not asked";
  {
    const test::NoDescriptors none;
    change = watch.Change();
  }
  EXPECT_THAT(change, IsEmpty());
}

}  // namespace
}  // namespace giveway::link
