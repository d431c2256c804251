// Partitions, QoS and impairments: whether two participants that meet also communicate on a topic.
#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>

#include "services/fleetctl/why/why_rules.h"
#include "services/qos/deployment.h"
#include "services/qos/request_offered.h"

namespace giveway::fleetctl {
namespace {

constexpr double kMuchLoss = 0.5;

std::string Baseless(const std::string& file) { return file.substr(file.rfind('/') + 1); }

// "deadline 300 ms (slow.xml:88)".
std::string PolicyText(const qos::Profile& profile, qos::Policy policy) {
  const qos::Value& value = profile[policy];
  const std::string text =
      fmt::format("{} {}", qos::Info(policy).name, qos::Text(policy, value.number));
  if (!value.given) return text + " (library default)";
  return fmt::format("{} ({}:{})", text, Baseless(value.place.file), value.place.line);
}

const qos::Profile* ProfileOf(const ProcessSituation& process, qos::Owner owner,
                              const std::string& topic) {
  const auto topics = qos::FleetTopics();
  const auto found = std::ranges::find(topics, topic, &qos::Topic::name);
  if (!process.profiles || found == topics.end()) return nullptr;
  const char* const end = owner == qos::Owner::kWriter ? "_writer" : "_reader";
  return process.profiles->Find(owner, std::string(found->stem) + end);
}

void CheckInstances(const ProcessSituation& hearer, const qos::Profile& reader,
                    std::uint32_t vehicles, Causes* causes) {
  const std::int64_t most = reader.Number(qos::Policy::kMaxInstances);
  if (most <= 0 || most >= vehicles) return;
  causes->push_back(
      {{qos::Severity::kWarning, "instance_limit", reader[qos::Policy::kMaxInstances].place,
        reader.name,
        fmt::format("{} takes {}, {} vehicles speak", NameOf(hearer),
                    PolicyText(reader, qos::Policy::kMaxInstances), vehicles),
        "Samples of vehicles beyond the limit are refused without a sign; which, is chance.",
        "max_instances 0, unlimited"},
       Weight::kMayPrevent});
}

void CheckWriterInstances(const ProcessSituation& speaker, const qos::Profile& writer,
                          Causes* causes) {
  if (writer.Number(qos::Policy::kMaxInstances) >= 0) return;
  causes->push_back(
      {{qos::Severity::kError, "writer_instances", writer[qos::Policy::kMaxInstances].place,
        writer.name,
        fmt::format("{} has {}", NameOf(speaker), PolicyText(writer, qos::Policy::kMaxInstances)),
        "A writer of Fast DDS 2.9.1 with a negative limit delivers nothing.",
        "max_instances 0, unlimited"},
       Weight::kPrevents});
}

bool FitsBetween(const ImpairmentRule& rule, const ProcessSituation& hearer,
                 const LaunchOptions& speaker) {
  if (rule.to_vehicle != kNoVehicle && rule.to_vehicle != hearer.launch.id) return false;
  switch (rule.from) {
    case ImpairedSender::kAnyone:
      return true;
    case ImpairedSender::kVehicles:
      return !speaker.is_world;
    case ImpairedSender::kWorld:
      return speaker.is_world;
    case ImpairedSender::kOneVehicle:
      return !speaker.is_world && rule.from_vehicle == speaker.id;
  }
  return false;
}

bool HoldsForATime(const ImpairmentRule& rule) { return rule.from_s || rule.to_s; }

bool LosesMuch(const ImpairmentRule& rule) {
  return rule.loss >= kMuchLoss || rule.burst * rule.burst_loss >= kMuchLoss;
}

// The rule that applies to the hearer's packets from the speaker: the last of those that match and
// are always active.
const ImpairmentRule* RuleBetween(const ProcessSituation& hearer, const LaunchOptions& speaker) {
  const ImpairmentRule* last = nullptr;
  for (const ImpairmentRule& rule : hearer.launch.impairment.rules) {
    if (FitsBetween(rule, hearer, speaker) && !HoldsForATime(rule)) last = &rule;
  }
  return last;
}

}  // namespace

void CheckPartitions(const ProcessSituation& hearer, const ProcessSituation& speaker,
                     const TopicOutlook& topic, Causes* causes) {
  if (topic.topic != "fleet/beacon") return;  // all others are the same in every area
  const std::string written = fmt::format("{}/v{}", speaker.launch.area, Number(speaker.launch.id));
  if (fnmatch(topic.read_in.c_str(), written.c_str(), 0) == 0) return;
  const char* const open = speaker.launch.partition_free ? " and without a partition" : "";
  causes->push_back(
      {{qos::Severity::kError,
        "partition_apart",
        {},
        "area",
        fmt::format("{} reads partition {}, {} writes {}{}", NameOf(hearer), topic.read_in,
                    NameOf(speaker), written, open),
        speaker.launch.partition_free
            ? "The names do not match, no wildcard matches what has none, and no status reports it."
            : "The names do not match, and no status of DDS reports it.",
        "the same area in the scenarios of both"},
       Weight::kPrevents});
}

void CheckPolicies(const ProcessSituation& hearer, const ProcessSituation& speaker,
                   const TopicOutlook& topic, std::uint32_t vehicles, Causes* causes) {
  const qos::Profile* const reader = ProfileOf(hearer, qos::Owner::kReader, topic.topic);
  const qos::Profile* const writer = ProfileOf(speaker, qos::Owner::kWriter, topic.topic);
  if (reader == nullptr || writer == nullptr) return;
  for (const qos::MatchRule* rule : qos::Broken(*writer, *reader)) {
    if (!rule->enforced) continue;  // both are Fast DDS
    causes->push_back({{qos::Severity::kError, std::string(rule->name),
                        (*writer)[rule->policy].place, writer->name + " to " + reader->name,
                        fmt::format("{} offers {}, {} requests {}", NameOf(speaker),
                                    PolicyText(*writer, rule->policy), NameOf(hearer),
                                    PolicyText(*reader, rule->policy)),
                        "The two never match, and the reader hears nothing.",
                        "change one of the two: " + std::string(rule->rule)},
                       Weight::kPrevents});
  }
  CheckWriterInstances(speaker, *writer, causes);
  if (!speaker.launch.is_world) CheckInstances(hearer, *reader, vehicles, causes);
}

namespace {

void CheckRulesOfATime(const ProcessSituation& hearer, const ProcessSituation& speaker,
                       const std::string& who, Causes* causes) {
  const auto& rules = hearer.launch.impairment.rules;
  const auto holds = [&](const ImpairmentRule& rule) {
    return HoldsForATime(rule) && (LosesMuch(rule) || !rule.blackouts.empty()) &&
           FitsBetween(rule, hearer, speaker.launch);
  };
  const auto first = std::ranges::find_if(rules, holds);
  if (first == rules.end()) return;
  causes->push_back(
      {{qos::Severity::kWarning,
        "impaired_for_a_time",
        {},
        "impairment",
        fmt::format("{}: by {} rules that hold for a time, the first {}", who,
                    std::ranges::count_if(rules, holds),
                    first->from_s ? fmt::format("from {:g} s after the start", *first->from_s)
                                  : fmt::format("to {:g} s after the start", *first->to_s)),
        "In such a time little or nothing is heard.",
        "wait until it is over, or take it out of --impair or the scenario"},
       Weight::kMayPrevent});
}

}  // namespace

void CheckImpairment(const ProcessSituation& hearer, const ProcessSituation& speaker,
                     Causes* causes) {
  const std::string who = fmt::format("{} drops what comes of {}", NameOf(hearer), NameOf(speaker));
  CheckRulesOfATime(hearer, speaker, who, causes);
  const ImpairmentRule* const rule = RuleBetween(hearer, speaker.launch);
  if (rule == nullptr) return;
  const bool deaf = rule->loss >= 1;
  if (LosesMuch(*rule)) {
    causes->push_back(
        {{deaf ? qos::Severity::kError : qos::Severity::kWarning,
          deaf ? "impaired_deaf" : "impaired_much",
          {},
          "impairment",
          fmt::format("{}: loss {:g}, bursts {:g} of the time", who, rule->loss, rule->burst),
          deaf ? "The impaired transport hands nothing of it on." : "Most samples do not arrive.",
          "less loss in --impair, or in impair { } of the scenario"},
         deaf ? Weight::kPrevents : Weight::kBeside});
  }
  if (rule->blackouts.empty()) return;
  const Blackout& first = rule->blackouts.front();
  causes->push_back(
      {{qos::Severity::kWarning,
        "impaired_blackout",
        {},
        "impairment",
        fmt::format("{}: everything from {:g} s to {:g} s after the start, {} windows", who,
                    first.from_s, first.to_s, rule->blackouts.size()),
        "In such a window nothing is heard.",
        "wait until it is over, or take it out of --impair or the scenario"},
       Weight::kMayPrevent});
}

}  // namespace giveway::fleetctl
