// The result of `fleetctl why`, combined and printed. Pure: prediction and probe in, verdicts, text
// and exit code out.
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
  bool predicted = true;    // false: one of the two is not
  std::vector<TopicOutlook> topics;
  // Found by the probe alone; here and below. Without a place in a world a vehicle communicates
  // only with worlds.
  bool hearer_without_place = false;
  bool speaker_without_place = false;
  std::optional<ProbeResult> probe;  // absent: not requested
  std::vector<std::string> not_known;
  std::optional<std::uint16_t> host_id;  // of the speaker, as predicted
};

enum class Verdict : std::uint8_t { kHears, kDoesNot, kNotKnown };

struct TopicVerdict {
  Verdict verdict = Verdict::kNotKnown;
  bool disagree = false;    // prediction and probe
  std::string explanation;  // "predicted: hears; probed: heard 40 samples, the first after 31 ms"
};

// The default time limit of the probe: longer if something should be received, because discovery
// takes time through a lossy channel.
double ListenSeconds(const std::vector<TopicOutlook>& topics);

// Adds the reason that only the probe shows, not /proc: a vehicle that has no place in a world yet.
void AddNotJoined(const ProcessSituation& hearer, const ProcessSituation& speaker,
                  WhyReport* report);

// Adds what discovery reports of endpoints that will not match, if that could not be predicted
// because one of the two processes is not visible.
void AddUnfit(WhyReport* report);

TopicVerdict VerdictOf(const WhyReport& report, const TopicOutlook& topic);
// A contradiction between the hearer's own status and the verdict; empty if there is none.
std::string Contradiction(const WhyReport& report);

std::string ToText(const WhyReport& report);
std::string ToJson(const WhyReport& report);
// 0 hears on every topic; 1 does not, or prediction and probe disagree; 2 nothing is known.
int ExitCode(const WhyReport& report);

}  // namespace giveway::fleetctl
