#include "services/config/writing/scenario_edit.h"

#include <google/protobuf/text_format.h>

#include "scenario.pb.h"
#include "services/config/config_dir.h"
#include "services/config/problem.h"
#include "services/config/text_file.h"

namespace giveway {

std::string EditScenario(const std::string& path, const ScenarioEdit& edit) {
  const std::string file = ResolveScenario(path);
  schema::Scenario scenario;
  if (!google::protobuf::TextFormat::ParseFromString(ReadTextFile(file), &scenario)) {
    throw InputError({{file, 0, "", "", "is no scenario", "see idl/scenario.proto"}});
  }
  if (edit.duration_s) scenario.set_duration_s(*edit.duration_s);
  if (edit.start_with) scenario.set_start_with(*edit.start_with);
  if (!edit.keep_impairment) scenario.clear_impair();
  if (!edit.keep_faults) scenario.clear_faults();
  for (const PlannedFault& kill : edit.kills) {
    schema::Fault* written = scenario.add_fault();
    written->set_kill(Number(kill.vehicle));
    written->set_at_s(kill.at_s.value_or(0));
  }
  std::string text;
  google::protobuf::TextFormat::PrintToString(scenario, &text);
  return text;
}

}  // namespace giveway
