// Any text as a fault file: either faults that keep every rule and read back as they are printed,
// or problems that a person can read.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/config/faults/faults_file.h"
#include "services/config/impair.h"
#include "services/config/problem.h"
#include "services/faults/channel.h"
#include "services/faults/exclusion.h"
#include "services/faults/kind_table.h"
#include "services/faults/schedule_text.h"
#include "services/types/check.h"
#include "tests/fuzz/target.h"
#include "tests/fuzz/text_input.h"

namespace giveway::fuzz {
namespace {

constexpr faults::Course kCourse{.seed = 1, .duration_s = 600, .warm_up_s = 5, .healing_s = 10};
constexpr std::size_t kReadBackAtMost = 200;

void CheckFault(const faults::Fault& fault) {
  const faults::KindRow& row = faults::RowOf(fault.kind);
  GIVEWAY_CHECK(fault.at_s >= 0 && fault.EndsAt_s() <= kCourse.duration_s - kCourse.healing_s);
  GIVEWAY_CHECK(row.Allows(fault.target.what) && (fault.for_s > 0) == row.takes_time);
  for (const faults::QuantityRow& taken : row.numbers) {
    const auto value = Get(fault.parameters, taken.quantity);
    GIVEWAY_CHECK(value && *value >= taken.low && *value <= taken.high, row.word);
  }
  GIVEWAY_CHECK(!Line(fault).empty());
}

void CheckSchedule(const faults::Schedule& schedule, const std::vector<VehicleId>& vehicles) {
  for (const faults::Fault& fault : schedule) CheckFault(fault);
  faults::ForEachExcluding(schedule, [](std::size_t, std::size_t) { GIVEWAY_CHECK(false); });
  if (schedule.size() > kReadBackAtMost) return;
  static MemoryFile file;
  const std::string text = AsTextproto(schedule);
  if (text.empty()) return;
  file.Hold(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  const faults::Expansion again = LoadAndExpandFaults(file.Path(), fuzz::kCourse, vehicles);
  GIVEWAY_CHECK(again.schedule == schedule, text);
  for (const auto& [hearer, impairment] : ImpairmentOf(schedule, vehicles)) {
    if (std::ssize(impairment.rules) > kMaxImpairRules) continue;
    const ParsedImpairment parsed = ParseImpairment(ImpairmentText(impairment));
    GIVEWAY_CHECK(parsed.problems.empty() && parsed.impairment == impairment, text);
  }
}

}  // namespace

std::vector<Input> Samples() { return TextFilesOf({GIVEWAY_FAULTS, GIVEWAY_FUZZ_FAULTS}); }

}  // namespace giveway::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace giveway;
  static fuzz::MemoryFile file;
  static const std::vector<VehicleId> vehicles = {VehicleId{1}, VehicleId{2}, VehicleId{3}};
  file.Hold(data, size);
  try {
    fuzz::CheckSchedule(LoadAndExpandFaults(file.Path(), fuzz::kCourse, vehicles).schedule,
                        vehicles);
  } catch (const InputError& error) {
    fuzz::CheckProblems(error);
  }
  return 0;
}
