// Which beacon QoS `fleetctl qos tune` tries, and in what order it spends time on them. Pure: the
// same base, options and evidence give the same plan, which makes a search resumable.
//
// Searched are the requested and the offered deadline, the liveliness lease, reliability and the
// reader's depth of fleet/beacon. Not searched: the beacon period, which is the scenario's tick and
// no QoS, and the heartbeat of reliable writers, which code sets to 100 ms and no profile changes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "services/fleetctl/tune/tune_evidence.h"
#include "services/qos/profile_edit.h"
#include "services/qos/profile_set.h"
#include "services/types/time.h"

namespace giveway::fleetctl {

// The searched policies of the profiles fleet_beacon_writer and fleet_beacon_reader. Durations are
// finite.
struct BeaconQos {
  Nanoseconds offered{0};
  Nanoseconds requested{0};
  Nanoseconds lease{0};  // of both ends
  bool reliable = false;
  std::int64_t depth = 1;  // of the reader

  friend bool operator==(const BeaconQos&, const BeaconQos&) = default;
};

struct TuneCandidate {
  std::string name;  // "base", or its values: "d190_l250_be_h4"
  BeaconQos qos;
};

// Empty if the base can be tuned, else what prevents it.
std::string WhyNotTunable(const qos::ProfileSet& base);
BeaconQos BeaconQosOf(const qos::ProfileSet& base);

struct TunePlanOptions {
  Nanoseconds tick{50'000'000};
  bool quick = false;
  std::size_t most = 1000;  // candidates, the base among them
};

// The base first, each QoS once.
std::vector<TuneCandidate> MakeCandidates(const BeaconQos& base, const TunePlanOptions& options);
// Its differences from the base's file.
std::vector<qos::ProfileEdit> EditsOf(const BeaconQos& wanted, const BeaconQos& base);

// Successive halving (Jamieson and Talwalkar 2016): all get one trial, the better half one more,
// then the better half of those as many again as they had, and so on.
struct Rung {
  std::size_t candidates = 0;  // at most; the base is always among them
  std::uint32_t trials = 0;    // each has had when it is over
};
std::vector<Rung> MakeRungs(std::size_t candidates, bool quick);

// All trials of the same number have one seed: candidates get the same losses and the same kills,
// as far as real time permits.
std::uint32_t TrialSeed(std::uint32_t seed, bool verification, std::uint32_t trial);

}  // namespace giveway::fleetctl
