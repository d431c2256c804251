// Verifies a prediction: a short-lived reader of our own takes the hearer's place (its domain,
// profile set, interface, impairment, network and mount namespace) and listens to the speaker.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "services/fleetctl/why/why_rules.h"

namespace giveway::fleetctl {

struct ProbedTopic {
  bool matched = false;
  std::uint64_t samples = 0;
  std::optional<double> first_ms;  // since the probe started
  // Whether a reader of the hearer's own matches a writer of the speaker's, by what discovery
  // reports of both, and if not, why; neither if it reports nothing of one of them.
  bool fits = false;
  std::string unfit;
};

// The hearer's own status, if one was received.
struct ReceiverReport {
  std::uint32_t peers_heard = 0;  // near enough, and with a fresh beacon
  std::uint32_t taken = 0;        // beacons of any vehicle, since it started; here and below
  std::uint32_t accepted = 0;
  std::uint32_t too_far = 0;  // from beyond the emission radius: received, and ignored
  std::uint32_t rejected = 0;
  std::uint32_t incompatible = 0;  // writers whose QoS does not match
};

struct ProbeResult {
  std::string trouble;  // why there was no probe; empty if there was
  double listened_ms = 0;
  bool discovered = false;  // a writer of the speaker was found
  bool hearer_discovered = false;
  // A vehicle without a place in a world publishes no beacons, and reads none: its writers name no
  // vehicle.
  bool joined = false;
  bool hearer_joined = false;
  std::optional<std::uint16_t> host_id;       // as its participant reports it
  std::map<std::string, ProbedTopic> topics;  // by name
  std::optional<ReceiverReport> receiver_report;
  // The vendor of its DDS, if it is not ours.
  std::string hearer_foreign;
  std::string speaker_foreign;
  // Writers and readers that should match one of the hearer's and do not, and why.
  std::vector<std::string> unfit;
};

struct ProbeOrder {
  // Identified by their participants, else by their process ids; if pid_inside is 0, by the
  // vehicle's id: its process is not visible.
  const ProcessSituation& hearer;
  const ProcessSituation& speaker;
  bool hearer_here = true;  // its process is visible; else only its place is known
  const std::vector<TopicOutlook>& topics;
  double seconds = 0;  // at most
};

// Runs in a child process: this one enters no namespace and loads no profiles. Ends as soon as
// every topic was received.
ProbeResult Probe(const ProbeOrder& order);

// The vehicles that are received in the place of a process, by the low half of their process ids:
// the only source for the id of a vehicle that asked the world for any. Ends when all that are
// wanted are known, or after two seconds; empty on failure.
std::map<std::uint16_t, VehicleId> ListenForNames(const ProcessSituation& place,
                                                  const std::set<std::uint16_t>& wanted);

}  // namespace giveway::fleetctl
