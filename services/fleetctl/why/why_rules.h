// Predicts whether one process can hear another, from the situations of both. Pure: two situations
// in, for each topic an outlook and its causes out. A probe (why_probe.h) then verifies it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/fleetctl/survey/why_situation.h"
#include "services/qos/finding.h"

namespace giveway::fleetctl {

enum class Outlook : std::uint8_t {
  kHears,
  kCannot,
  kNotKnown,  // a fact that decides it is not known
};

enum class Weight : std::uint8_t {
  kPrevents,
  kMayPrevent,
  kBeside,  // does not prevent it, but should be reported
};

struct Cause {
  qos::Finding finding;
  Weight weight = Weight::kPrevents;
  // False if it is only about the hearing process: another reader in its place would receive.
  bool in_place = true;
};
using Causes = std::vector<Cause>;

// One topic the hearer reads and the speaker writes.
struct TopicOutlook {
  std::string topic;
  std::string read_in;  // the partition of the hearer's reader
  Outlook outlook = Outlook::kHears;
  Outlook in_place = Outlook::kHears;  // for another reader in the hearer's place
  Causes causes;                       // those that prevent it come first, in the order of cause
};

// What the hearer reads of the speaker: between vehicles beacons, and of the world the data of the
// vehicle's sensors. Nothing between two worlds.
std::vector<TopicOutlook> TopicsBetween(const LaunchOptions& hearer, const LaunchOptions& speaker);

// `vehicles`: the number of vehicles in the hearer's domain, as far as is known.
std::vector<TopicOutlook> Predict(const ProcessSituation& hearer, const ProcessSituation& speaker,
                                  std::uint32_t vehicles);

// The rules, by subject; each adds its findings, in the order of cause.
void CheckDomains(const ProcessSituation& hearer, const ProcessSituation& speaker, Causes* causes);
void CheckNetworks(const ProcessSituation& hearer, const ProcessSituation& speaker, Causes* causes);
void CheckSharedMemory(const ProcessSituation& hearer, const ProcessSituation& speaker,
                       Causes* causes);
void CheckDiscovery(const ProcessSituation& hearer, const ProcessSituation& speaker,
                    Causes* causes);
void CheckPartitions(const ProcessSituation& hearer, const ProcessSituation& speaker,
                     const TopicOutlook& topic, Causes* causes);
void CheckPolicies(const ProcessSituation& hearer, const ProcessSituation& speaker,
                   const TopicOutlook& topic, std::uint32_t vehicles, Causes* causes);
void CheckProcess(const ProcessSituation& process, bool hears, Causes* causes);
void CheckImpairment(const ProcessSituation& hearer, const ProcessSituation& speaker,
                     Causes* causes);

}  // namespace giveway::fleetctl
