#include "services/qos/profile_check.h"

#include <algorithm>
#include <iterator>

#include "services/qos/qos_rules.h"
#include "services/qos/schema_check.h"
#include "services/qos/xml_tree.h"

namespace giveway::qos {
namespace {

void CheckSet(const ProfileSet& set, const Deployment& deployment, Findings* findings) {
  CheckNames(set, deployment, findings);
  for (const Profile& profile : set.profiles) {
    if (profile.owner == Owner::kParticipant) continue;
    CheckEndpoint(profile, findings);
    if (const Topic* topic = TopicOfProfile(profile.name)) {
      CheckFleet(profile, *topic, deployment, findings);
    }
  }
  CheckParticipants(set, deployment, findings);
  CheckTransports(set, deployment, findings);
}

void SortByLine(std::size_t from, Findings* findings) {
  std::stable_sort(findings->begin() + static_cast<std::ptrdiff_t>(from), findings->end(),
                   [](const Finding& a, const Finding& b) { return a.place.line < b.place.line; });
}

void Cut(Findings* findings) {
  if (findings->size() <= kMostFindings) return;
  const std::size_t more = findings->size() - kMostFindings;
  // An error among what is cut keeps its weight.
  const bool error = ExitCode(*findings) == 2;
  findings->resize(kMostFindings);
  findings->push_back({error ? Severity::kError : Severity::kWarning,
                       "more_findings",
                       {findings->front().place.file, 0},
                       "",
                       std::to_string(more) + " more",
                       "They are not shown.",
                       "correct these first"});
}

}  // namespace

Findings Check(const std::vector<ProfileFile>& files, const Deployment& deployment) {
  return Check(files, deployment, {});
}

Findings Check(const std::vector<ProfileFile>& files, const Deployment& deployment,
               const std::vector<ComposeSet>& set_of) {
  Findings findings;
  CheckSurroundings(deployment, &findings);
  std::vector<ProfileSet> sets;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const ProfileFile& file = files[i];
    const std::size_t before = findings.size();
    XmlRead read = ReadXml(file.bytes, file.name);
    std::ranges::move(read.findings, std::back_inserter(findings));
    if (read.root) {
      CheckSchema(*read.root, file.name, &findings);
      sets.push_back(ReadProfiles(*read.root, file.name));
      CheckSet(sets.back(), deployment, &findings);
      CheckPairs(sets.back(), sets.back(), &findings);
      for (const ComposeSet& given : set_of) {
        if (given.file == i) CheckComposeSet(given.service, sets.back(), &findings);
      }
    }
    SortByLine(before, &findings);
  }
  for (const ProfileSet& writers : sets) {
    for (const ProfileSet& readers : sets) {
      if (&writers != &readers) CheckPairs(writers, readers, &findings);
      if (&writers < &readers) CheckFindEachOther(writers, readers, &findings);
    }
  }
  Cut(&findings);
  return findings;
}

std::string WhyRefused(const ProfileFile& file, const Deployment& deployment) {
  std::string why;
  for (const Finding& finding : Check({file}, deployment)) {
    if (finding.severity != Severity::kError) continue;
    why += (why.empty() ? "QoS file " : "\n") + finding.place.file;
    if (finding.place.line > 0) why += ":" + std::to_string(finding.place.line);
    if (!finding.subject.empty()) why += ": " + finding.subject;
    why += ": " + finding.values + ": " + finding.consequence;
    if (why.ends_with('.')) why.pop_back();
    why += "; " + finding.remedy;
  }
  // What a file holds must not command the terminal it is shown on.
  std::ranges::replace_if(
      why, [](char c) { return c != '\n' && (static_cast<unsigned char>(c) < 0x20 || c == 0x7f); },
      '?');
  return why;
}

int ExitCode(const Findings& findings) {
  if (findings.empty()) return 0;
  const bool error = std::ranges::any_of(
      findings, [](const Finding& finding) { return finding.severity == Severity::kError; });
  return error ? 2 : 1;
}

}  // namespace giveway::qos
