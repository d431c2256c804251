// Measures how timely a vehicle is, turn by turn, over its whole life: what it decided by and how
// old that was, how evenly its ticks came, and how far it drove between a cause and the first scan
// that shows its wheels obeying. All from what travels anyhow: scans and beacons carry ticks, and a
// decision names the tick that first showed its cause. Times are those at which this vehicle took
// its scans, so no other clock is believed, but for the latency of samples: that is the
// difference of two wall clocks. Reads no clock, decides nothing. Pure.
//
//   scan of the cause's tick -> ... -> decided -> command sent -> scan with obeying wheels
//   |<---------------------- reaction, in us and in um ----------------------->|
//
// A command that is lost, or a motor that is weak, makes a reaction longer: it ends when the wheels
// are seen to slow down, not when something was sent.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "services/types/decision_evidence.h"
#include "services/types/figures/drive_figures.h"
#include "services/types/figures/measured_figure.h"
#include "services/types/motor_command.h"
#include "services/types/range_scan.h"
#include "services/types/time.h"
#include "services/types/vehicle_options.h"

namespace giveway {

// One turn of a control loop.
struct TurnSeen {
  SteadyTime woke{0};               // the arrival of the scan, where one came
  SteadyTime sent{0};               // the command is out
  const RangeScan* scan = nullptr;  // null: none came
  // From publishing to reception, by wall clocks: of the newest scan, and the longest of the
  // beacons.
  std::optional<Nanoseconds> scan_latency;
  std::optional<Nanoseconds> beacon_latency;
  MotorCommand command;
  DecisionEvidence evidence;
};

class DriveTiming {
 public:
  // Causes older than this are not measured.
  static constexpr std::uint32_t kRememberedTicks = 64;
  // Wheels that do not obey for so long: the reaction ends there, and counts as that long.
  static constexpr std::uint32_t kMostTicks = 40;

  explicit DriveTiming(const VehicleOptions& options) : options_(options) {}

  // It drives by other options from now on; the figures continue.
  void Reseat(const VehicleOptions& options);
  // What the turn showed. A reaction that ended with it and spent its budget, if one did.
  std::optional<ReactionMargin> Note(const TurnSeen& turn);

  DriveFigures Figures() const;

 private:
  struct Moment {
    Tick tick = kNoTick;
    SteadyTime at{0};
    double odometer_m = 0;  // the axle centre's, as the encoders counted it
  };
  // Of a decision that slows the vehicle down: until its wheels obey.
  struct Reaction {
    Moment cause;
    Tick decided = kNoTick;
    double speed_m_s = 0;          // as it was decided
    double wanted_m_s = 0;         // by the command
    std::optional<double> free_m;  // at the cause
  };

  void Add(DriveFigure figure, double value);
  void AddLatency(DriveFigure figure, std::optional<Nanoseconds> latency);
  void NoteScan(const RangeScan& scan, SteadyTime woke);
  std::optional<ReactionMargin> SeekEnd();
  void SeekBegin(const TurnSeen& turn);
  Moment MomentOf(Tick tick) const;
  bool Obeys(const Reaction& reaction) const;

  VehicleOptions options_;
  std::array<MeasuredFigure, kDriveFigures> figures_;
  std::array<Moment, kRememberedTicks> moments_{};  // [tick % kRememberedTicks]
  WorldEpoch epoch_ = kNoEpoch;
  Moment last_;           // the newest scan
  double speed_m_s_ = 0;  // in it, forward
  std::optional<Reaction> reaction_;
  std::optional<ReactionMargin> narrowest_;
  std::uint32_t budget_spent_ = 0;
  std::uint32_t received_before_sent_ = 0;
};

}  // namespace giveway
