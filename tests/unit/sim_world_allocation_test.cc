// Counts every allocation of this program: a tick in which nothing happens makes none.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "services/types/math.h"
#include "sim_world/run.h"
#include "tests/unit/sim_scenario.h"

namespace {

std::atomic<std::uint64_t> allocations{0};

}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
// Not inlined: g++ would see free() meet a pointer from operator new, which is what is meant here.
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace giveway::sim {
namespace {

TEST(Allocation, ATickWithoutEventsAllocatesNothing) {
  Scenario scenario;
  for (std::uint32_t id = 1; id <= 8; ++id) {
    scenario.vehicles.push_back(VehicleAt(id, {{id * 2.0, 0}, kPi / 2}));
  }
  scenario.walls = {{{0, -1}, {20, -1}}, {{0, 90}, {20, 90}}};
  sim::Run run(scenario, kEpoch);
  for (const VehicleOptions& options : scenario.vehicles) run.Join(options.id);
  std::vector<MotorCommand> commands(scenario.vehicles.size());
  const auto advance = [&] {
    for (std::uint32_t id = 1; id <= 8; ++id) commands[id - 1] = Drive(id, run.Now(), 3, 3.1);
    run.Advance(commands);
  };
  const std::uint64_t before_joining = allocations;
  EXPECT_GT(before_joining, 0U);  // the count works
  run.Start();
  for (int i = 0; i < 10; ++i) advance();
  const std::uint64_t before = allocations;
  std::size_t events = 0;
  for (int i = 0; i < 500; ++i) {
    advance();
    events += run.Events().size();
  }
  EXPECT_EQ(allocations - before, 0U);
  EXPECT_EQ(events, 0U);
}

}  // namespace
}  // namespace giveway::sim
