// The effect of one fault of a vehicle's ultrasonics on its scans, tick by tick, from the fault's
// start to its end. Its memory is bounded: for kSonarDelayed 10 s of scans, for others at most one
// scan. Knows one body; world_faults.h decides which bodies a fault affects, and when.
//
//   kSonarOff           a transducer that fired heard nothing: clear
//   kSonarStuck         the readings from the fault's start, with the times of the firings since
//   kSonarGarbage       clear with probability 1/4, else any possible range, drawn for each firing
//   kSonarWrong         ranges times `factor`; clear if that is beyond max_range_m
//   kSonarSlow          readings change only once per period_s, and state when they were fired
//   kSonarDelayed       readings of delay_s ago, and state when they were fired; until the first
//                       of them arrives, those from the fault's start
//   kSonarIntermittent  a scan is as for kSonarOff with `probability`, drawn for each
#pragma once

#include <cstdint>
#include <vector>

#include "services/faults/fault.h"
#include "services/types/range_scan.h"
#include "services/types/robot_model.h"
#include "services/types/time.h"

namespace giveway::sim {

class SonarFault {
 public:
  // The fault's parameters are filled in. `draws` is its own: of the run's seed, its rule and
  // number.
  SonarFault(const faults::Fault& fault, std::uint64_t draws, Nanoseconds tick_period);

  // Takes in the scan of that driving tick, from 1, as the ultrasonics made it. Once a tick. Draws
  // count from the start signal, however long the world waited for it.
  void Alter(const RobotModel& profile, std::uint32_t driven_tick, RangeScan* scan);

 private:
  using Readings = decltype(RangeScan::readings);

  void Hold(RangeScan* scan);
  void Delay(RangeScan* scan);
  void Freeze(RangeScan* scan);
  void Scramble(const RobotModel& profile, std::uint32_t driven_tick, RangeScan* scan) const;
  void Scale(const RobotModel& profile, RangeScan* scan) const;

  faults::Kind kind_;
  double factor_;
  double probability_;
  std::uint32_t every_ticks_;   // of kSonarSlow
  std::uint32_t behind_ticks_;  // of kSonarDelayed
  std::uint64_t draws_;
  std::uint32_t scans_ = 0;     // taken in
  std::vector<Readings> kept_;  // a ring of behind_ticks_; of other kinds the one that is held
};

}  // namespace giveway::sim
