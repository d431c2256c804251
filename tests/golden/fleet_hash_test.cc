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
                         testing::Values(Golden{Behaviour::kCooperative, 0xbbe619785b150fe7ULL},
                                         Golden{Behaviour::kLectureAvoid, 0x52c3bbeddef10a45ULL},
                                         Golden{Behaviour::kStockAvoid, 0xe05b022f3c0e04dfULL},
                                         Golden{Behaviour::kLectureYield, 0xecfa5f6db85deea7ULL},
                                         Golden{Behaviour::kLecturePrinted, 0x3dc35c2d9b0f98daULL}),
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
                         testing::Values(GoldenScenario{"head_on", 0x3b104081616aa399ULL},
                                         GoldenScenario{"three_way", 0x7c53c69f0b32ecafULL},
                                         GoldenScenario{"four_way", 0x9521ea23246a48ddULL},
                                         GoldenScenario{"deaf", 0xc7cb37157b774b02ULL},
                                         GoldenScenario{"parked_nose_to_nose",
                                                        0xac1dca11551e274fULL},
                                         GoldenScenario{"convoy", 0x2a8ef5a4f517f5b1ULL}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace giveway
