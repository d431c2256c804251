// World and brains together, pinned: the same run gives the same bits in every build and on every
// machine, down to what each brain remembers. A change of a hash is a change of behaviour.
#include <gtest/gtest.h>

#include <ostream>

#include "services/app/scenario_file.h"
#include "services/types/state_hash.h"
#include "tests/support/crossing.h"

namespace giveway {
namespace {

// Of every tick.
std::uint64_t HashOf(const Scenario& scenario) {
  sim::VirtualFleet fleet(scenario);
  StateHash hash;
  while (fleet.Advance()) {
    hash.Add(fleet.World().Hash());
    for (std::size_t i = 0; i < fleet.Size(); ++i) hash.Add(fleet.Brain(i).Hash());
  }
  return hash.Value();
}

struct Golden {
  Behaviour behaviour;
  std::uint64_t hash;

  friend void PrintTo(const Golden& golden, std::ostream* out) { *out << Name(golden.behaviour); }
};

class FleetHash : public testing::TestWithParam<Golden> {};

TEST_P(FleetHash, IsTheSameEverywhere) {
  const std::uint64_t hash = HashOf(test::Crossing(GetParam().behaviour, 0.4, 0.3));
  EXPECT_EQ(hash, GetParam().hash) << std::hex << "got 0x" << hash;
}

INSTANTIATE_TEST_SUITE_P(Crossing, FleetHash,
                         testing::Values(Golden{Behaviour::kCooperative, 0xb8e5fa06b76e3209ULL},
                                         Golden{Behaviour::kLectureAvoid, 0x50c29e6aa4cfa63fULL},
                                         Golden{Behaviour::kStockAvoid, 0xcd3fd6afeda41c48ULL},
                                         Golden{Behaviour::kLectureYield, 0x4cc60e58d1d60ff9ULL},
                                         Golden{Behaviour::kLecturePrinted, 0x145257f8f63f2f83ULL}),
                         [](const auto& test) { return std::string(Name(test.param.behaviour)); });

struct GoldenScenario {
  const char* name;
  std::uint64_t hash;

  friend void PrintTo(const GoldenScenario& golden, std::ostream* out) { *out << golden.name; }
};

class ScenarioHash : public testing::TestWithParam<GoldenScenario> {};

TEST_P(ScenarioHash, IsTheSameEverywhere) {
  app::ScenarioOverrides overrides;
  overrides.seed = 1;
  const std::uint64_t hash = HashOf(app::LoadScenario(GetParam().name, overrides));
  EXPECT_EQ(hash, GetParam().hash) << std::hex << "got 0x" << hash;
}

INSTANTIATE_TEST_SUITE_P(Shipped, ScenarioHash,
                         testing::Values(GoldenScenario{"head_on", 0x2e148929d34a400bULL},
                                         GoldenScenario{"three_way", 0x8acb1e10a2d162e2ULL},
                                         GoldenScenario{"four_way", 0x26980017c233f67eULL},
                                         GoldenScenario{"deaf", 0x92da9b702846222cULL},
                                         GoldenScenario{"parked_nose_to_nose",
                                                        0xc5dda272be3361ffULL},
                                         GoldenScenario{"convoy", 0x3327d21a1a0ad65bULL}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace giveway
