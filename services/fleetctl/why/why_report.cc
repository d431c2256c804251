#include "services/fleetctl/why/why_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "services/fleetctl/output/finding_text.h"
#include "services/runtime/json.h"
#include "services/runtime/utf8.h"

namespace giveway::fleetctl {
namespace {

// Discovery takes a moment: what was missing for less than this may only be late.
constexpr double kLongEnoughMs = 1000;

bool Probed(const WhyReport& report) { return report.probe && report.probe->trouble.empty(); }

ProbedTopic ProbedOf(const WhyReport& report, const std::string& topic) {
  if (!Probed(report)) return {};
  const auto found = report.probe->topics.find(topic);
  return found == report.probe->topics.end() ? ProbedTopic{} : found->second;
}

std::string_view Word(Outlook outlook) {
  switch (outlook) {
    case Outlook::kHears:
      return "hears";
    case Outlook::kCannot:
      return "cannot";
    case Outlook::kNotKnown:
      break;
  }
  return "not known";
}

std::string_view Word(Verdict verdict) {
  switch (verdict) {
    case Verdict::kHears:
      return "hears";
    case Verdict::kDoesNot:
      return "does not hear";
    case Verdict::kNotKnown:
      break;
  }
  return "may hear";
}

// How far the probe came: found, matched, heard.
std::string ProbedText(const WhyReport& report, const std::string& topic) {
  if (!report.probe) return "not probed";
  if (!Probed(report)) return "not probed: " + report.probe->trouble;
  const ProbedTopic probed = ProbedOf(report, topic);
  if (probed.samples > 0) {
    return fmt::format("probed: heard {} sample{}, the first after {:.0f} ms", probed.samples,
                       probed.samples == 1 ? "" : "s", probed.first_ms.value_or(0));
  }
  const char* const far = probed.matched             ? "its writer matched"
                          : report.probe->discovered ? "it was discovered, but no writer matched"
                                                     : "it was not discovered";
  return fmt::format("probed: nothing in {:.1f} s, {}", report.probe->listened_ms * 1e-3, far);
}

// Every cause once, in order; those that prevent reception come first.
std::vector<Cause> CausesOf(const WhyReport& report) {
  std::vector<Cause> all;
  for (const TopicOutlook& topic : report.topics) {
    for (const Cause& cause : topic.causes) {
      const bool known = std::ranges::any_of(all, [&](const Cause& other) {
        return other.finding.rule == cause.finding.rule &&
               other.finding.subject == cause.finding.subject &&
               other.finding.values == cause.finding.values;
      });
      if (!known) all.push_back(cause);
    }
  }
  std::ranges::stable_sort(all, {}, &Cause::weight);
  return all;
}

bool AnyDisagrees(const WhyReport& report) {
  return !Contradiction(report).empty() ||
         std::ranges::any_of(report.topics, [&](const TopicOutlook& topic) {
           return VerdictOf(report, topic).disagree;
         });
}

std::string ReceiverReportText(const WhyReport& report) {
  if (!Probed(report) || !report.probe->receiver_report) return {};
  const ReceiverReport& word = *report.probe->receiver_report;
  return fmt::format(
      "its own status: {} near peer{} with a fresh beacon; of {} beacons taken since it started {} "
      "accepted, {} from too far, {} rejected; {} incompatible writer{}",
      word.peers_heard, word.peers_heard == 1 ? "" : "s", word.taken, word.accepted, word.too_far,
      word.rejected, word.incompatible, word.incompatible == 1 ? "" : "s");
}

Cause UnfitCause(const std::string& line) {
  return {{qos::Severity::kError,
           "endpoint_unfit",
           {},
           "as discovered",
           line,
           "The two never match, and nothing that the one writes reaches the other.",
           "the partitions and QoS of idl/FOREIGN.md"},
          Weight::kPrevents,
          true};
}

std::string HostIdText(const WhyReport& report) {
  if (!Probed(report) || !report.probe->host_id || !report.host_id) return {};
  if (*report.probe->host_id == *report.host_id) return {};
  return fmt::format(
      "host id of {}: {:#06x} by its addresses now, {:#06x} as it reports itself: its addresses "
      "have changed since it started",
      report.speaker, *report.host_id, *report.probe->host_id);
}

Json TopicJson(const WhyReport& report, const TopicOutlook& topic) {
  const TopicVerdict verdict = VerdictOf(report, topic);
  const ProbedTopic probed = ProbedOf(report, topic.topic);
  Json object;
  object["topic"] = topic.topic;
  object["verdict"] = Word(verdict.verdict);
  if (report.predicted) object["predicted"] = Word(topic.outlook);
  if (report.predicted) object["predicted_in_place"] = Word(topic.in_place);
  if (Probed(report)) {
    object["matched"] = probed.matched;
    object["samples"] = probed.samples;
    object["first_ms"] = OrNull(probed.first_ms);
    if (!report.hearer_here) object["fits"] = probed.fits;
  }
  object["disagree"] = verdict.disagree;
  std::vector<std::string> reasons;
  for (const Cause& cause : topic.causes) {
    if (cause.weight == Weight::kPrevents) reasons.push_back(cause.finding.rule);
  }
  object["reasons"] = reasons;
  return object;
}

// Whether the vehicle was discovered, and without a place.
bool IsWithoutPlace(const LaunchOptions& launch, bool discovered, bool joined, double listened_ms) {
  return !launch.is_world && discovered && !joined && listened_ms >= kLongEnoughMs;
}

bool NeedsPlace(const TopicOutlook& topic) {
  return topic.topic != "fleet/join" && topic.topic != "world/roster";
}

// Whether the hearer itself cannot receive, though another reader in its place might.
bool IsItselfDeaf(const WhyReport& report, const TopicOutlook& topic) {
  return (topic.outlook == Outlook::kCannot && topic.in_place != Outlook::kCannot) ||
         (report.hearer_without_place && NeedsPlace(topic));
}

Cause NotJoined(const ProcessSituation& process, bool hears) {
  return {{qos::Severity::kError,
           "not_joined",
           {},
           NameOf(process),
           "has no place in a world: it was discovered, and none of its writers names a vehicle",
           hears ? "It reads nothing but the answer of a world."
                 : "It writes nothing but its request for a place.",
           "start giveway-world in its domain and network; its log says what it waits for"},
          Weight::kPrevents,
          !hears};
}

}  // namespace

double ListenSeconds(const std::vector<TopicOutlook>& topics) {
  const bool silent = std::ranges::all_of(
      topics, [](const TopicOutlook& topic) { return topic.in_place == Outlook::kCannot; });
  return silent ? 3 : 10;
}

void AddNotJoined(const ProcessSituation& hearer, const ProcessSituation& speaker,
                  WhyReport* report) {
  if (!Probed(*report)) return;
  const ProbeResult& probe = *report->probe;
  report->hearer_without_place = IsWithoutPlace(hearer.launch, probe.hearer_discovered,
                                                probe.hearer_joined, probe.listened_ms);
  report->speaker_without_place =
      IsWithoutPlace(speaker.launch, probe.discovered, probe.joined, probe.listened_ms);
  for (TopicOutlook& topic : report->topics) {
    if (!NeedsPlace(topic)) continue;
    if (report->hearer_without_place) topic.causes.push_back(NotJoined(hearer, true));
    if (report->speaker_without_place) topic.causes.push_back(NotJoined(speaker, false));
    std::ranges::stable_sort(topic.causes, {}, &Cause::weight);
  }
}

void AddUnfit(WhyReport* report) {
  if (!Probed(*report) || report->predicted) return;
  for (TopicOutlook& topic : report->topics) {
    const ProbedTopic probed = ProbedOf(*report, topic.topic);
    if (!report->hearer_here && !probed.unfit.empty()) {
      topic.causes.push_back(UnfitCause(fmt::format("{}: {}", topic.topic, probed.unfit)));
    }
    if (!report->hearer_here || probed.samples > 0) continue;
    for (const std::string& line : report->probe->unfit) {
      if (line.find(" of " + topic.topic + " ") == line.npos) continue;
      topic.causes.push_back(UnfitCause(line));
    }
  }
}

TopicVerdict VerdictOf(const WhyReport& report, const TopicOutlook& topic) {
  TopicVerdict verdict;
  const bool heard = ProbedOf(report, topic.topic).samples > 0;
  const bool own = IsItselfDeaf(report, topic);
  if (Probed(report)) {
    verdict.verdict = heard && !own ? Verdict::kHears : Verdict::kDoesNot;
    // A process elsewhere may be in another situation than the probe: discovery reports its own
    // readers.
    if (!report.hearer_here) {
      const ProbedTopic probed = ProbedOf(report, topic.topic);
      verdict.verdict = !probed.unfit.empty()  ? Verdict::kDoesNot
                        : heard && probed.fits ? Verdict::kHears
                                               : Verdict::kNotKnown;
    }
    verdict.disagree = report.predicted && topic.in_place != Outlook::kNotKnown &&
                       heard != (topic.in_place == Outlook::kHears);
    // The prediction does not know that the speaker has no place: that is no disagreement.
    if (!heard && report.speaker_without_place && NeedsPlace(topic)) verdict.disagree = false;
  } else if (topic.outlook != Outlook::kNotKnown && report.predicted) {
    verdict.verdict = topic.outlook == Outlook::kHears ? Verdict::kHears : Verdict::kDoesNot;
  }
  const std::string predicted =
      !report.predicted ? "not predicted"
      : own && topic.outlook == Outlook::kCannot
          ? fmt::format("predicted: cannot, another in its place {}", Word(topic.in_place))
          : fmt::format("predicted: {}", Word(topic.outlook));
  verdict.explanation = predicted + "; " + ProbedText(report, topic.topic);
  return verdict;
}

std::string Contradiction(const WhyReport& report) {
  if (!Probed(report) || !report.probe->receiver_report || !report.predicted) return {};
  for (const TopicOutlook& topic : report.topics) {
    if (IsItselfDeaf(report, topic)) return "it cannot, and yet it publishes its status";
    const bool hears = VerdictOf(report, topic).verdict == Verdict::kHears;
    const double heard_for_ms =
        report.probe->listened_ms - ProbedOf(report, topic.topic).first_ms.value_or(0);
    if (topic.topic == "fleet/beacon" && hears && report.probe->receiver_report->taken == 0 &&
        heard_for_ms >= kLongEnoughMs) {
      return "a reader in its place hears, and by its own status it took no beacon at all";
    }
  }
  return {};
}

std::string ToText(const WhyReport& report) {
  std::string text;
  for (const TopicOutlook& topic : report.topics) {
    const TopicVerdict verdict = VerdictOf(report, topic);
    text += fmt::format("{} {} {} on {} ({})\n", report.hearer, Word(verdict.verdict),
                        report.speaker, topic.topic, verdict.explanation);
  }
  for (const Cause& cause : CausesOf(report)) text += ToText(cause.finding, "processes");
  if (AnyDisagrees(report)) {
    const std::string more = Contradiction(report);
    text += "prediction and probe disagree" + (more.empty() ? "" : ": " + more) + "\n";
  }
  for (const std::string& line : {ReceiverReportText(report), HostIdText(report)}) {
    if (!line.empty()) text += line + "\n";
  }
  for (const std::string& fact : report.not_known) text += Printable("not known: " + fact) + "\n";
  return text;
}

std::string ToJson(const WhyReport& report) {
  Json object;
  object["hearer"] = report.hearer;
  object["speaker"] = report.speaker;
  object["hears"] = ExitCode(report) == 0;
  object["disagree"] = AnyDisagrees(report);
  object["probed"] = Probed(report);
  if (report.probe && !Probed(report)) {
    object["trouble"] = report.probe->trouble;
  }
  if (Probed(report)) object["listened_ms"] = report.probe->listened_ms;
  if (Probed(report) && !report.probe->hearer_foreign.empty()) {
    object["hearer_foreign"] = report.probe->hearer_foreign;
  }
  if (Probed(report) && !report.probe->speaker_foreign.empty()) {
    object["speaker_foreign"] = report.probe->speaker_foreign;
  }
  if (Probed(report) && report.probe->receiver_report) {
    const ReceiverReport& word = *report.probe->receiver_report;
    Json own;
    own["peers_heard"] = word.peers_heard;
    own["taken"] = word.taken;
    own["accepted"] = word.accepted;
    own["too_far"] = word.too_far;
    own["rejected"] = word.rejected;
    own["incompatible"] = word.incompatible;
    object["own_status"] = std::move(own);
  }
  object["topics"] =
      JsonArray(report.topics, [&](const TopicOutlook& topic) { return TopicJson(report, topic); });
  object["findings"] =
      JsonArray(CausesOf(report), [](const Cause& cause) { return ToJson(cause.finding); });
  object["not_known"] = report.not_known;
  return JsonText(std::move(object)) + "\n";
}

int ExitCode(const WhyReport& report) {
  if (!report.predicted && !Probed(report)) return 2;
  const auto any = [&](Verdict verdict) {
    return std::ranges::any_of(report.topics, [&](const TopicOutlook& topic) {
      return VerdictOf(report, topic).verdict == verdict;
    });
  };
  if (any(Verdict::kDoesNot) || AnyDisagrees(report)) return 1;
  return any(Verdict::kNotKnown) ? 2 : 0;
}

}  // namespace giveway::fleetctl
