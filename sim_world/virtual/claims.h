// Whether claims hold (vehicle/situation/claim.h): a vehicle last heard some ticks ago is, by the
// truth, where its beacon of then claims that it can be, and so is the place where it would stand
// if it braked now, straight on. Checks every beacon that a peer may still use, because others may
// have been lost. And a vehicle that brakes as hard as it can stays, until it stands, in what it
// claimed when it started, turning or not.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "services/types/scenario.h"
#include "services/vehicle/situation/claim.h"
#include "sim_world/virtual/observed.h"

namespace giveway::sim {

class Claims {
 public:
  explicit Claims(const Scenario& scenario);

  // Processes one tick. Vehicles in order of their ids, each with its beacon; without one nothing
  // is judged. Returns those that leave a claim of theirs from this tick on, by index; valid until
  // the next.
  std::span<const std::uint32_t> Observe(Tick tick, std::span<const Observed> vehicles);

 private:
  // A beacon, and what each claim by it is made of.
  struct SentBeacon {
    Beacon beacon;
    giveway::Course course;
    double slack_m = 0;
  };
  struct Track {
    double deceleration_m_s2 = 0;
    double reaction_s = 0;
    std::vector<SentBeacon> said;  // [tick % size], as many as peers keep clear of
    std::optional<Claim> braking;  // of when it started to brake; empty: it does not
    double braking_slack_m = 0;
    bool reported = false;
  };

  static SentBeacon Keep(const Beacon& beacon);
  // The beacon sent that many ticks ago; null if none was.
  static const SentBeacon* SaidBefore(Tick tick, std::uint32_t ago, const Track& track);
  bool StaysWhileBraking(Tick tick, const Observed& now, Track* track) const;
  // Of all beacons that a peer may still use. A beacon is received a tick after it is sent, and
  // applies to the motion in the tick after that.
  bool StaysInAll(Tick tick, const Observed& now, const Track& track) const;
  std::uint32_t Step(std::uint32_t ago) const;

  double dt_s_;
  std::uint32_t oldest_ticks_ = 2;  // no vehicle keeps clear of an older claim
  std::uint32_t fresh_ticks_ = 2;   // every claim up to this age is judged
  std::vector<Track> tracks_;
  std::vector<std::uint32_t> left_;
};

}  // namespace giveway::sim
