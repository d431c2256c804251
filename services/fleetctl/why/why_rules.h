// Whether one process can hear another, predicted from where both stand. Pure: two situations in,
// for each topic an outlook and its causes out. A probe (why_probe.h) then shows whether it is so.
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
  kBeside,  // does not prevent it, but should be known
};

struct Cause {
  qos::Finding finding;
  Weight weight = Weight::kPrevents;
  // False if it is about the hearing process alone: another reader in its place would hear.
  bool in_place = true;
};
using Causes = std::vector<Cause>;

// One topic the hearer reads and the speaker writes.
struct TopicOutlook {
  std::string topic;
  std::string read_in;  // the partition of the hearer's reader
  Outlook outlook = Outlook::kHears;
  Outlook in_place = Outlook::kHears;  // of another reader in the hearer's place
  Causes causes;                       // what prevents comes first, in the order of cause
};

// What the hearer reads of the speaker: vehicles of one another beacons, and of the world what the
// vehicle is fitted with. Nothing between two worlds.
std::vector<TopicOutlook> TopicsBetween(const Instructions& hearer, const Instructions& speaker);

// `vehicles` is how many vehicles speak in the hearer's domain, as far as is known.
std::vector<TopicOutlook> Predict(const ProcessSituation& hearer, const ProcessSituation& speaker,
                                  std::uint32_t vehicles);

// The rules, by what they look at; each adds what it finds, in the order of cause.
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
