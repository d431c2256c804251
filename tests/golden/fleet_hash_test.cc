// World and brains together, pinned: the same run gives the same bits in every build and on every
// machine, down to what each brain remembers. A change of a hash is a change of behaviour.
#include <gtest/gtest.h>

#include <ostream>

#include "services/config/scenario_file.h"
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
                         testing::Values(Golden{Behaviour::kCooperative, 0xa8daf0b25a15d8bfULL},
                                         Golden{Behaviour::kLectureAvoid, 0xfa667c8a15b53f38ULL},
                                         Golden{Behaviour::kStockAvoid, 0xaa467e89e787cc05ULL},
                                         Golden{Behaviour::kLectureYield, 0xdc5d190684d77a14ULL},
                                         Golden{Behaviour::kLecturePrinted, 0xe3978ff6ef5fa30aULL}),
                         [](const auto& test) { return std::string(Name(test.param.behaviour)); });

struct GoldenScenario {
  const char* name;
  std::uint64_t hash;

  friend void PrintTo(const GoldenScenario& golden, std::ostream* out) { *out << golden.name; }
};

class ScenarioHash : public testing::TestWithParam<GoldenScenario> {};

TEST_P(ScenarioHash, IsTheSameEverywhere) {
  ScenarioOverrides overrides;
  overrides.seed = 1;
  const std::uint64_t hash = HashOf(LoadScenario(GetParam().name, overrides));
  EXPECT_EQ(hash, GetParam().hash) << std::hex << "got 0x" << hash;
}

INSTANTIATE_TEST_SUITE_P(Shipped, ScenarioHash,
                         testing::Values(GoldenScenario{"head_on", 0xffcdebfcdff7c6ddULL},
                                         GoldenScenario{"three_way", 0xbb626e7e9ab12a06ULL},
                                         GoldenScenario{"four_way", 0x8a977c1fedf4696fULL},
                                         GoldenScenario{"deaf", 0xe4986410270e132aULL},
                                         GoldenScenario{"parked_nose_to_nose",
                                                        0x05c004ef78eebef9ULL},
                                         GoldenScenario{"convoy", 0x4acbd1b6d49af8e2ULL}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace giveway
