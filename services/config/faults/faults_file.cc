#include "services/config/faults/faults_file.h"

#include <utility>

#include "faults.pb.h"
#include "services/config/config_dir.h"
#include "services/config/faults/faults_read.h"
#include "services/config/section.h"
#include "services/config/text_file.h"

namespace giveway {

faults::FaultFile LoadFaults(const std::string& path) {
  const std::string name = ResolveFaults(path);
  const Section root = ParseText(name, ReadTextFile(name, kMaxFaultFileBytes),
                                 schema::FaultFile::default_instance());
  faults::FaultFile file = ReadFaultFile(root);
  file.name = name;
  std::vector<Problem> problems = root.Problems();
  if (!problems.empty()) throw InputError(std::move(problems));
  return file;
}

std::vector<Problem> ProblemsOf(const faults::FaultFile& file, const faults::Expansion& expansion) {
  ProblemList problems;
  for (const faults::Refusal& refusal : expansion.refused) {
    problems.Add({.file = file.name,
                  .line = refusal.line,
                  .field = refusal.rule + (refusal.field.empty() ? "" : "." + refusal.field),
                  .message = refusal.message,
                  .remedy = refusal.remedy});
  }
  return problems.Sorted();
}

faults::Expansion LoadAndExpandFaults(const std::string& path, const faults::Course& course,
                                      std::span<const VehicleId> vehicles) {
  const faults::FaultFile file = LoadFaults(path);
  faults::Expansion expansion = Expand(file, course, vehicles);
  if (!expansion.refused.empty()) throw InputError(ProblemsOf(file, expansion));
  return expansion;
}

}  // namespace giveway
