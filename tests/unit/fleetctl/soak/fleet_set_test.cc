// Which faults a fleet's profile set keeps from having an effect.
#include "services/fleetctl/soak/verb/fleet_set.h"

#include <gmock/gmock.h>

#include "services/fleetctl/args/qos_files.h"

namespace giveway::fleetctl {
namespace {

using ::testing::HasSubstr;

std::string WhyNot(const std::string& fleet, faults::Kind kind, const std::string& of_fault) {
  faults::Fault fault;
  fault.kind = kind;
  fault.parameters.qos = of_fault;
  return FleetSet(ResolveQosFile(fleet)).WhyNot(fault);
}

TEST(FleetSet, AMismatchTakesBeaconsThatDoNotMatch) {
  EXPECT_EQ(WhyNot("default", faults::Kind::kQosMismatch, "lossy_radio"), "");
  EXPECT_EQ(WhyNot("lossy_radio", faults::Kind::kQosMismatch, "default"), "");
  EXPECT_EQ(WhyNot("same_host", faults::Kind::kQosMismatch, "lossy_radio"), "");
  for (const char* const set : {"default", "lossy_radio"}) {
    EXPECT_THAT(WhyNot(set, faults::Kind::kQosMismatch, set), HasSubstr("match")) << set;
  }
  EXPECT_EQ(WhyNot("default", faults::Kind::kQosApply, "default"), "");
}

// A vehicle that is given both does not start.
TEST(FleetSet, ThroughSharedMemoryNothingIsImpaired) {
  EXPECT_THAT(WhyNot("same_host", faults::Kind::kLoss, ""), HasSubstr("shared memory"));
  EXPECT_THAT(WhyNot("same_host", faults::Kind::kPartition, ""), HasSubstr("shared memory"));
  EXPECT_EQ(WhyNot("same_host", faults::Kind::kPause, ""), "");
  EXPECT_EQ(WhyNot("default", faults::Kind::kLoss, ""), "");
}

}  // namespace
}  // namespace giveway::fleetctl
