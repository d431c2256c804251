// Predicts a candidate's figures by arithmetic alone, for comparison with the measurement: where
// the two differ by more than chance, either the model or the system is not what we think. Pure.
//
// The model. A beacon is sent every tick T, and half a tick late if its sender's scan was lost
// (services/vehicle_node/main.cc waits one and a half). Beacons are lost, delayed and jittered as
// types/impairment.h says. A silence of m lost beacons lasts (m + 1) T from arrival to arrival:
// deadline and lease report it if it is longer than they are; the age limit, checked once a tick on
// beacons of the tick before, if m T is, and sooner if the receiver's own scans were lost. An event
// between two loop cycles is acted on in the second.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "services/fleetctl/tune/tune_evidence.h"
#include "services/fleetctl/tune/tune_plan.h"
#include "services/types/impairment.h"
#include "services/types/time.h"

namespace giveway::fleetctl {

// The channel from any vehicle to any other.
struct BeaconChannel {
  double loss = 0;
  double burst = 0;  // Gilbert-Elliott, as ImpairmentRule
  double burst_length = 5;
  double burst_loss = 1;
  double delay_ms = 0;
  double jitter_ms = 0;
  double scan_loss = 0;  // of the world's packets: in all, and how they come in bursts
  double scan_burst = 0;
  double scan_burst_length = 5;
  double scan_burst_loss = 1;
};

// nullopt if the impairment is not the same for all, or has no closed form: a rate limit,
// blackouts, reordering, corruption.
std::optional<BeaconChannel> ChannelOf(const Impairment& impairment);

// Probability that a beacon arrives and the next `lost` do not.
double SilenceProbability(const BeaconChannel& channel, int lost);

struct TuneFleet {
  std::uint32_t vehicles = 4;
  double tick_ms = 50;
  double age_limit_ms = 200;
};

struct Prediction {
  double alarms_per_hour = 0;  // per vehicle, over all of its peers
  double detection_ms = 0;     // mean, from the target's last beacon
  double age_mean_ms = 0;      // of beacons at a decision
};

// nullopt for reliable beacons: the gain of a retransmission depends on the library's timers.
std::optional<Prediction> Predict(const BeaconQos& qos, const BeaconChannel& channel,
                                  const TuneFleet& fleet);

// A message if measured and predicted differ by more than chance, empty if they agree.
std::string Disagreement(const TuneFigures& measured, const Prediction& predicted);

}  // namespace giveway::fleetctl
