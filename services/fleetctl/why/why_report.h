// What `fleetctl why` found, put together and printed. Pure: predicted and probed in, verdicts,
// text and exit code out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/fleetctl/why/why_probe.h"
#include "services/fleetctl/why/why_rules.h"

namespace giveway::fleetctl {

struct WhyReport {
  std::string hearer;  // "vehicle 1 (pid 7)"
  std::string speaker;
  bool hearer_here = true;  // it is on this machine
  bool foretold = true;     // false: one of the two is not
  std::vector<TopicOutlook> topics;
  // Found by the probe alone; here and below. Without a place in a world a vehicle talks to worlds.
  bool hearer_without_place = false;
  bool speaker_without_place = false;
  std::optional<ProbeResult> probe;  // absent: not asked for
  std::vector<std::string> not_known;
  std::optional<std::uint16_t> host_id;  // of the speaker, as predicted
};

enum class Verdict : std::uint8_t { kHears, kDoesNot, kNotKnown };

struct TopicVerdict {
  Verdict verdict = Verdict::kNotKnown;
  bool disagree = false;    // of what was predicted with what was probed
  std::string explanation;  // "predicted: hears; probed: heard 40 samples, the first after 31 ms"
};

// At most how long the probe listens by default: longer where something should be heard, for
// through a channel that loses packets discovery takes its time.
double ListenSeconds(const std::vector<TopicOutlook>& topics);

// Adds the reason that no file of /proc shows and the probe does: a vehicle that has no place in a
// world yet.
void AddNotJoined(const ProcessSituation& hearer, const ProcessSituation& speaker,
                  WhyReport* report);

// Adds what discovery reports of endpoints that will not match, where that could not be predicted
// because one of the two is no process that can be seen.
void AddUnfit(WhyReport* report);

TopicVerdict VerdictOf(const WhyReport& report, const TopicOutlook& topic);
// What the hearer's own status says against the verdict; empty if it agrees or says nothing.
std::string Contradiction(const WhyReport& report);

std::string ToText(const WhyReport& report);
std::string ToJson(const WhyReport& report);
// 0 hears on every topic; 1 does not, or prediction and probe disagree; 2 nothing is known.
int ExitCode(const WhyReport& report);

}  // namespace giveway::fleetctl
