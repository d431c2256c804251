// Whether one vehicle with new QoS performs worse than the rest of its fleet with the old: compares
// counts of the same time span. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "services/types/fleet_facts.h"
#include "services/types/time.h"

namespace giveway::fleetctl {

// What a vehicle counted between two of its reports, or several vehicles together.
struct ServiceFigures {
  std::uint64_t alarms = 0;  // deadlines missed and livelinesses lost of its peers
  std::uint64_t lost = 0;    // beacons that never arrived
  std::uint64_t taken = 0;   // beacons that did
  double seconds = 0;        // time, of every vehicle counted
  double pair_seconds = 0;   // time, for each peer near enough to be heard

  ServiceFigures& operator+=(const ServiceFigures& other);
  double AlarmsPerPairHour() const;
  double LostShare() const;
  double TakenPerSecond() const;  // of one vehicle
};

// Of one vehicle, from one report to a later one of the same process.
ServiceFigures Between(const VehicleStatus& before, const VehicleStatus& after, double seconds);

// What vehicles reported, in the order it came. Behind an order that restarts a process there are
// still reports of the former one.
class SeenVehicles {
 public:
  struct Seen {
    VehicleStatus first;
    SteadyTime first_at{0};
    VehicleStatus last;
    SteadyTime last_at{0};
    bool restarted = false;  // its process: that counts from zero
  };
  void Add(const VehicleStatus& status, SteadyTime now);
  bool Contains(VehicleId vehicle) const { return seen_.contains(vehicle); }
  // Whether its process has taken a beacon; with `since_restart` only the one that was seen to
  // start.
  bool Hears(VehicleId vehicle, bool since_restart) const;
  const std::map<VehicleId, Seen>& All() const { return seen_; }

 private:
  std::map<VehicleId, Seen> seen_;
};

// Why `canary` performs worse than `rest`, or cannot be judged; empty if it does not. Worse means
// more than chance: the counts are assumed to be Poisson, and the difference of two rates must
// exceed three standard deviations and a fifth of the rest's rate.
std::string WhyWorse(const ServiceFigures& canary, const ServiceFigures& rest);

}  // namespace giveway::fleetctl
