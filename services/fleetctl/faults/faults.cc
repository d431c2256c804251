#include "services/fleetctl/faults/faults.h"

#include <cstdio>
#include <vector>

#include "services/config/faults/faults_file.h"
#include "services/faults/expand.h"
#include "services/fleetctl/faults/faults_show.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/output/terminal_text.h"

namespace giveway::fleetctl {
namespace {

int Print(const std::string& text) {
  if (!PrintAll(text)) throw OutputError("stdout did not take all of it");
  return 0;
}

// A list without faults looks like a file without rules.
void ReportNoTime(const faults::Course& course, const faults::Expansion& expansion) {
  const bool no_time = course.warm_up_s + course.healing_s >= course.duration_s;
  if (!no_time || !expansion.schedule.empty()) return;
  std::fprintf(stderr,
               "no faults: a warm-up of %g s and a healing of %g s leave no time in %g s; give a "
               "longer --duration, or shorter --warm-up and --healing\n",
               course.warm_up_s, course.healing_s, course.duration_s);
}

faults::Course CourseOf(const FaultsOptions& options) {
  return {.seed = options.seed,
          .duration_s = options.duration_s,
          .warm_up_s = options.warm_up_s.value_or(
              faults::WarmUpOfSoak_s(options.duration_s, options.vehicles)),
          .healing_s = options.healing_s.value_or(faults::HealingOfSoak_s(options.duration_s))};
}

}  // namespace

int RunFaultsExpand(const FaultsOptions& options) {
  std::vector<VehicleId> vehicles;
  for (std::uint32_t id = 1; id <= options.vehicles; ++id) vehicles.push_back(VehicleId{id});
  const faults::Course course = CourseOf(options);
  const faults::Expansion expansion = LoadAndExpandFaults(options.file, course, vehicles);
  ReportNoTime(course, expansion);
  if (options.json) return Print(ExpansionJson(expansion));
  return Print(options.text ? FoldedForTerminal(ExpansionText(expansion))
                            : ExpansionFile(expansion));
}

int RunFaultsList(bool json) { return Print(json ? KindsJson() : FoldedForTerminal(KindsText())); }

}  // namespace giveway::fleetctl
