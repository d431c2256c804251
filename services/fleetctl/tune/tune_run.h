// The verb `fleetctl qos tune`: tries beacon QoS on real vehicles under an impairment, measures
// each, and recommends one. Values in; the exit code out.
#pragma once

#include <cstdint>
#include <string>

namespace giveway::fleetctl {

struct QosTuneOptions {
  std::string base;  // path or name of a shipped set; empty: the default
  std::string impair = "loss=0.1";
  std::uint32_t vehicles = 4;
  std::uint32_t fleets = 0;  // in parallel; 0: two per core
  std::uint32_t seed = 1;
  std::string out = "qos-tune";
  bool quick = false;
  double trial_s = 0;               // observed while all live; 0: 20, quick 12
  std::uint32_t candidates = 1000;  // at most, the base among them
  std::uint32_t verify_trials = 0;  // for base and recommended each; 0: 6, quick 5
  bool json = false;
};

// 0: recommended was verified to have fewer false alarms and to notice no later; 1: nothing better
// than the base was found or verified, or interrupted; 2: could not run (or throws).
int RunQosTune(const QosTuneOptions& options);

}  // namespace giveway::fleetctl
