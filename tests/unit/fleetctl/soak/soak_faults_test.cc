// Which lists of faults a soak carries out.
#include "services/fleetctl/soak/verb/soak_faults.h"

#include <gmock/gmock.h>

#include "services/config/problem.h"

namespace giveway::fleetctl {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

faults::FaultFile Own(const std::string& rule) {
  faults::FaultFile own{.name = "mine.textproto"};
  own.at.push_back({.name = rule, .time_s = 20, .target = {.vehicle = VehicleId{1}}, .line = 3});
  return own;
}

SoakFaults With(const std::string& flag, const std::optional<faults::FaultFile>& own) {
  SoakOptions options;
  options.scenario = "mine";
  options.faults = flag;
  return FaultsOf(options, own);
}

TEST(SoakFaults, AreThoseOfCalmWhereNothingIsSaid) {
  const SoakFaults faults = With("", std::nullopt);
  ASSERT_THAT(faults.sources, SizeIs(1));
  EXPECT_THAT(faults.sources[0].random, testing::Not(IsEmpty()));
  EXPECT_EQ(faults.flag, "calm");
  EXPECT_EQ(faults.name, "calm");
}

TEST(SoakFaults, AreTheScenariosAloneWithoutTheFlag) {
  const SoakFaults faults = With("", Own("a"));
  ASSERT_THAT(faults.sources, SizeIs(1));
  EXPECT_EQ(faults.sources[0].name, "mine.textproto");
  EXPECT_EQ(faults.flag, "");
  EXPECT_EQ(faults.name, "mine");
}

TEST(SoakFaults, AreBothWithTheFlag) {
  const SoakFaults faults = With("everything", Own("a"));
  EXPECT_THAT(faults.sources, SizeIs(2));
  EXPECT_EQ(faults.flag, "everything");
  EXPECT_EQ(faults.name, "mine and everything");
  EXPECT_EQ(With("everything", std::nullopt).name, "everything");
}

TEST(SoakFaults, WithOneNameAreRefused) {
  const std::string name = With("calm", std::nullopt).sources[0].random[0].name;
  EXPECT_THROW(With("calm", Own(name)), InputError);
}

}  // namespace
}  // namespace giveway::fleetctl
