// The line that repeats a soak.
#include "services/fleetctl/soak/verb/soak_origin.h"

#include <gmock/gmock.h>

namespace giveway::fleetctl {
namespace {

TEST(SoakOrigin, TheCommandLineHasAllThatDecidesTheSoak) {
  SoakOptions options;
  options.scenario = "my fleet.textproto";
  options.faults = "everything";
  options.duration_s = 30 * 86400;
  options.seed = 7;
  options.report_folder = "it's here";
  options.interface = "eth0";
  options.qos_file = "lossy radio.xml";
  options.vehicles = 12;
  options.discovery_servers = 2;
  options.attacker = "bin/attacker";
  options.skip_unsupported = true;
  options.ring_s = 60;
  EXPECT_EQ(CommandLine(options),
            "fleetctl soak 'my fleet.textproto' --faults everything --duration 2592000 --seed 7 "
            "--report 'it'\\''s here' --vehicles 12 --qos 'lossy radio.xml' --interface eth0 "
            "--discovery-servers 2 --attacker bin/attacker --skip-unsupported --record-ring 60");
}

TEST(SoakOrigin, TheFaultsOfTheScenarioNeedNoFlag) {
  SoakOptions options;
  options.scenario = "mine";
  options.report_folder = "here";
  EXPECT_EQ(CommandLine(options), "fleetctl soak mine --duration 300 --seed 1 --report here");
}

TEST(SoakOrigin, NamesEachProgramThatRan) {
  const auto names = [](const SoakVersions& versions) {
    std::vector<std::string> all;
    for (const SoakProgram& program : versions.programs) all.push_back(program.name);
    return all;
  };
  const SoakVersions real = VersionsOf("/nowhere", false);
  EXPECT_THAT(names(real), ::testing::ElementsAre("fleetctl", "giveway-world", "giveway-vehicle"));
  EXPECT_NE(real.programs[0].build_id, "");
  EXPECT_EQ(real.programs[1].build_id, "");  // no such file
  EXPECT_THAT(names(VersionsOf("/nowhere", true)), ::testing::ElementsAre("fleetctl"));
}

}  // namespace
}  // namespace giveway::fleetctl
