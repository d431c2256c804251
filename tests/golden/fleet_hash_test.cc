// World and brains together, pinned: the same crossing gives the same bits in every build and on
// every machine, down to what each brain remembers. A change of a hash is a change of behaviour.
#include <gtest/gtest.h>

#include <ostream>

#include "services/types/state_hash.h"
#include "tests/support/crossing.h"

namespace giveway {
namespace {

struct Golden {
  Behaviour behaviour;
  std::uint64_t hash;

  friend void PrintTo(const Golden& golden, std::ostream* out) { *out << Name(golden.behaviour); }
};

class FleetHash : public testing::TestWithParam<Golden> {};

TEST_P(FleetHash, IsTheSameEverywhere) {
  sim::VirtualFleet fleet(test::Crossing(GetParam().behaviour, 0.4, 0.3));
  StateHash hash;
  while (fleet.Advance()) {
    hash.Add(fleet.World().Hash());
    hash.Add(fleet.Brain(0).Hash());
    hash.Add(fleet.Brain(1).Hash());
  }
  EXPECT_EQ(hash.Value(), GetParam().hash) << std::hex << "got 0x" << hash.Value();
}

INSTANTIATE_TEST_SUITE_P(Crossing, FleetHash,
                         testing::Values(Golden{Behaviour::kCooperative, 0x99fce240ad40fb99ULL},
                                         Golden{Behaviour::kLectureAvoid, 0x198adc168f55c55dULL},
                                         Golden{Behaviour::kStockAvoid, 0x81d4b84dc0c96424ULL},
                                         Golden{Behaviour::kLectureYield, 0x883612c5e72b625fULL}),
                         [](const auto& test) { return std::string(Name(test.param.behaviour)); });

}  // namespace
}  // namespace giveway
