#include "services/fleetctl/soak/host_faults/attackers.h"

#include <gmock/gmock.h>

namespace giveway::fleetctl {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Not;

faults::Fault OfIntruder(faults::Kind kind, faults::Target target) {
  faults::Fault fault;
  fault.kind = kind;
  fault.for_s = 3;
  fault.target = target;
  fault.parameters.rate_hz = 20;
  return fault;
}

TEST(Attackers, WithoutAProgramTheFlagIsNamedAndWhereTheProgramIs) {
  EXPECT_THAT(WhyNoAttacker("", true),
              AllOf(HasSubstr("--attacker"), HasSubstr("tests"), HasSubstr("root")));
}

TEST(Attackers, AProgramThatIsNotThereIsNamed) {
  EXPECT_THAT(WhyNoAttacker("/no/such/program", true),
              AllOf(HasSubstr("/no/such/program"), HasSubstr("No such file")));
}

TEST(Attackers, WithoutTheRightToHearPacketsThereIsNoAttack) {
  EXPECT_THAT(WhyNoAttacker("/bin/sh", false), HasSubstr("packet socket"));
  EXPECT_THAT(WhyNoAttacker("/bin/sh", true), IsEmpty());
}

TEST(Attackers, TheProgramIsToldOfTargetDomainAndRate) {
  const AttackerTools tools{"/bin/attacker", 17, "127.0.0.1"};
  const auto words =
      AttackWords(tools, OfIntruder(faults::Kind::kSpoofed, {.vehicle = VehicleId{4}}));
  EXPECT_THAT(std::vector(words.begin(), words.begin() + 2), ElementsAre("/bin/attacker", "spoof"));
  EXPECT_THAT(words, IsSupersetOf({"--vehicle", "4", "--domain", "17", "--rate", "20", "--seconds",
                                   "8", "--progress", "--source", "127.0.0.1"}));
}

TEST(Attackers, WhoMeansAllNamesNoVehicleAndANamedInterfaceIsNoAddress) {
  const AttackerTools tools{"/bin/attacker", 17, "eth0"};
  const auto words =
      AttackWords(tools, OfIntruder(faults::Kind::kFlooded, {faults::Target::What::kAll}));
  EXPECT_EQ(words[1], "flood");
  EXPECT_THAT(words,
              AllOf(Not(testing::Contains("--vehicle")), Not(testing::Contains("--source"))));
}

}  // namespace
}  // namespace giveway::fleetctl
