#include "services/config/campaign/campaign_file.h"

#include <utility>
#include <vector>

#include "campaign.pb.h"
#include "services/config/campaign/campaign_read.h"
#include "services/config/config_dir.h"
#include "services/config/faults/faults_file.h"
#include "services/config/problem.h"
#include "services/config/scenario_file.h"
#include "services/config/section.h"
#include "services/config/text_file.h"

namespace giveway {
namespace {

// Adds what `load` finds wrong.
template <typename Load>
void Gather(const Load& load, std::vector<Problem>* problems) {
  try {
    load();
  } catch (const InputError& error) {
    problems->insert(problems->end(), error.Problems().begin(), error.Problems().end());
  }
}

}  // namespace

CampaignPlan LoadCampaign(const std::string& path, std::span<const std::string_view> generators) {
  const std::string name = ResolveCampaign(path);
  const Section root =
      ParseText(name, ReadTextFile(name), schema::CampaignPlan::default_instance());
  CampaignPlan plan = ReadCampaign(root, generators);
  std::vector<Problem> problems = root.Problems();
  if (root.Has("scenario") && !plan.generators.front().empty()) {
    Gather(
        [&] {
          const std::string& scenario = plan.generators.front();
          LoadScenario(scenario, {.seed = 0});
          plan.scenario_text = ReadTextFile(ResolveScenario(scenario));
        },
        &problems);
  }
  if (!plan.fault_file.empty()) {
    Gather(
        [&] {
          LoadFaults(plan.fault_file);
          plan.fault_text = ReadTextFile(ResolveFaults(plan.fault_file), kMaxFaultFileBytes);
        },
        &problems);
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return plan;
}

}  // namespace giveway
