#include "services/config/faults/fault_sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "services/config/faults/faults_file.h"

namespace giveway {
namespace {

// The first line of each name. A list that was expanded has many faults of one.
std::map<std::string, int> NamesOf(const faults::FaultFile& file) {
  std::map<std::string, int> lines;
  for (const faults::AtRule& rule : file.at) lines.try_emplace(rule.name, rule.line);
  for (const faults::RandomRule& rule : file.random) lines.try_emplace(rule.name, rule.line);
  return lines;
}

// Each draw is a hash of the rule's name: two of one name would draw the same times.
std::vector<Problem> NamesInBoth(const faults::FaultFile& own, const faults::FaultFile& asked) {
  const std::map<std::string, int> names = NamesOf(own);
  ProblemList problems;
  for (const auto& [name, line] : NamesOf(asked)) {
    const auto other = names.find(name);
    if (other == names.end()) continue;
    problems.Add(
        {.file = asked.name,
         .line = line,
         .field = "name",
         .value = fmt::format("\"{}\"", name),
         .message = fmt::format("stands in line {} of {} too, which is carried out with it",
                                other->second, own.name),
         .remedy = "give one of the two another name"});
  }
  return problems.Sorted();
}

// The message names lines, which may be of two files.
std::string WhereOther(std::span<const faults::FaultFile> sources, const faults::Refusal& refusal,
                       const std::string& file) {
  if (refusal.other.empty()) return {};
  const std::string& other = FileOf(sources, refusal.other);
  return other == file ? "" : fmt::format("; {} stands in {}", refusal.other, other);
}

}  // namespace

std::vector<faults::FaultFile> LoadFaultSources(const std::optional<faults::FaultFile>& own,
                                                const std::string& path) {
  std::vector<faults::FaultFile> sources;
  if (own) sources.push_back(*own);
  if (path.empty()) return sources;
  sources.push_back(LoadFaults(path));
  if (!own) return sources;
  std::vector<Problem> problems = NamesInBoth(sources.front(), sources.back());
  if (!problems.empty()) throw InputError(std::move(problems));
  return sources;
}

faults::FaultFile Together(std::span<const faults::FaultFile> sources) {
  faults::FaultFile together;
  for (const faults::FaultFile& file : sources) {
    together.at.insert(together.at.end(), file.at.begin(), file.at.end());
    together.random.insert(together.random.end(), file.random.begin(), file.random.end());
  }
  return together;
}

const std::string& FileOf(std::span<const faults::FaultFile> sources, const std::string& rule) {
  const auto has = [&rule](const faults::FaultFile& file) {
    return std::ranges::find(file.at, rule, &faults::AtRule::name) != file.at.end() ||
           std::ranges::find(file.random, rule, &faults::RandomRule::name) != file.random.end();
  };
  // The last is the file asked for, which may be long.
  const auto before_last = sources.first(sources.size() - 1);
  const auto file = std::ranges::find_if(before_last, has);
  return file == before_last.end() ? sources.back().name : file->name;
}

std::vector<Problem> ProblemsOf(std::span<const faults::FaultFile> sources,
                                const faults::Expansion& expansion) {
  ProblemList problems;
  for (const faults::Refusal& refusal : expansion.refused) {
    if (problems.Full()) break;
    const std::string& file = FileOf(sources, refusal.rule);
    problems.Add({.file = file,
                  .line = refusal.line,
                  .field = refusal.rule + (refusal.field.empty() ? "" : "." + refusal.field),
                  .message = refusal.message + WhereOther(sources, refusal, file),
                  .remedy = refusal.remedy});
  }
  return problems.Sorted();
}

faults::Expansion ExpandFaults(std::span<const faults::FaultFile> sources,
                               const faults::Course& course, std::span<const VehicleId> vehicles) {
  faults::Expansion expansion = faults::Expand(Together(sources), course, vehicles);
  if (!expansion.refused.empty()) throw InputError(ProblemsOf(sources, expansion));
  return expansion;
}

}  // namespace giveway
