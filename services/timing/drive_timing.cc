#include "services/timing/drive_timing.h"

#include <algorithm>
#include <cmath>

namespace giveway {
namespace {

constexpr double kDrives_m_s = 0.05;      // slower, a reaction costs no distance worth reporting
constexpr double kNoise_m_s = 0.01;       // of an encoder's rate, in forward speed
constexpr double kLeastObedience = 0.25;  // of what the brakes could have taken off

double Microseconds(Nanoseconds duration) { return Milliseconds(duration) * 1e3; }

double WayOf(const RobotModel& profile, const WheelAngles& counted) {
  return profile.drive.wheel_radius_m / 2 * (counted.left_rad + counted.right_rad);
}

double Forward(const RobotModel& profile, const WheelSpeeds& wheels) {
  return TwistFromWheels(profile.drive, wheels).forward_m_s;
}

}  // namespace

void DriveTiming::Reseat(const VehicleOptions& options) {
  options_ = options;
  epoch_ = kNoEpoch;
  reaction_.reset();
}

void DriveTiming::Add(DriveFigure figure, double value) {
  figures_[static_cast<std::size_t>(figure)].Add(value);
}

void DriveTiming::AddLatency(DriveFigure figure, std::optional<Nanoseconds> latency) {
  if (!latency) return;
  if (*latency < Nanoseconds{0}) ++received_before_sent_;
  Add(figure, Microseconds(std::max(*latency, Nanoseconds{0})));
}

// Another world counts ticks and wheels again.
void DriveTiming::NoteScan(const RangeScan& scan, SteadyTime woke) {
  if (scan.epoch != epoch_) {
    epoch_ = scan.epoch;
    moments_.fill({});
    last_ = {};
    reaction_.reset();
  }
  if (last_.tick != kNoTick && scan.tick <= last_.tick) return;
  const Moment now{scan.tick, woke, WayOf(options_.profile, scan.counted)};
  if (last_.tick != kNoTick) {
    const Nanoseconds due = TicksBetween(last_.tick, now.tick) * options_.tick_period;
    const Nanoseconds off = now.at - last_.at - due;
    Add(DriveFigure::kTickJitter, Microseconds(off < Nanoseconds{0} ? -off : off));
  }
  moments_[Number(now.tick) % kRememberedTicks] = now;
  last_ = now;
  speed_m_s_ = Forward(options_.profile, scan.wheels);
}

// Of a tick whose scan did not come: computed back from the newest.
DriveTiming::Moment DriveTiming::MomentOf(Tick tick) const {
  const Moment& known = moments_[Number(tick) % kRememberedTicks];
  if (known.tick == tick) return known;
  const Nanoseconds since = TicksBetween(tick, last_.tick) * options_.tick_period;
  return {tick, last_.at - since, last_.odometer_m - speed_m_s_ * Seconds(since)};
}

bool DriveTiming::Obeys(const Reaction& reaction) const {
  const double slower_m_s =
      kLeastObedience * options_.profile.deceleration_m_s2 * Seconds(options_.tick_period);
  return speed_m_s_ <= std::max(reaction.wanted_m_s + kNoise_m_s, reaction.speed_m_s - slower_m_s);
}

std::optional<ReactionMargin> DriveTiming::SeekEnd() {
  if (!reaction_ || last_.tick <= reaction_->decided) return std::nullopt;
  const bool given_up = TicksBetween(reaction_->decided, last_.tick) >= kMostTicks;
  if (!Obeys(*reaction_) && !given_up) return std::nullopt;
  const Reaction reaction = *reaction_;
  reaction_.reset();
  const double driven_m = std::max(0.0, last_.odometer_m - reaction.cause.odometer_m);
  Add(DriveFigure::kReaction, Microseconds(last_.at - reaction.cause.at));
  Add(DriveFigure::kReactionDistance, driven_m * 1e6);
  if (!reaction.free_m) return std::nullopt;
  const ReactionMargin margin{reaction.decided, driven_m, *reaction.free_m};
  Add(DriveFigure::kReactionShare, (1 - margin.ShareLeft()) * 1e6);
  if (!narrowest_ || margin.ShareLeft() < narrowest_->ShareLeft()) narrowest_ = margin;
  if (margin.ShareLeft() >= kLeastShareLeft) return std::nullopt;
  ++budget_spent_;
  return margin;
}

// A decision that lets the vehicle continue ends the wait for one that did not; of two that slow it
// down the first one counts.
void DriveTiming::SeekBegin(const TurnSeen& turn) {
  const MotorCommand& command = turn.command;
  if (!command.decision_changed || last_.tick == kNoTick) return;
  const double wanted_m_s = Forward(options_.profile, command.target);
  const bool slows = wanted_m_s < speed_m_s_ - kNoise_m_s;
  if (!slows) reaction_.reset();
  const Tick cause = command.decision.cause_tick;
  const bool counts = slows && !reaction_ && speed_m_s_ > kDrives_m_s && cause != kNoTick &&
                      cause <= last_.tick && TicksBetween(cause, last_.tick) < kRememberedTicks;
  if (!counts) return;
  const Moment shown = MomentOf(cause);
  reaction_ = {.cause = shown,
               .decided = last_.tick,
               .speed_m_s = speed_m_s_,
               .wanted_m_s = std::max(0.0, wanted_m_s)};
  if (!turn.evidence.free_m) return;
  reaction_->free_m = *turn.evidence.free_m + std::max(0.0, last_.odometer_m - shown.odometer_m);
}

std::optional<ReactionMargin> DriveTiming::Note(const TurnSeen& turn) {
  std::optional<ReactionMargin> spent;
  if (turn.scan != nullptr) {
    if (turn.scan->run_state != RunState::kRunning) return std::nullopt;
    NoteScan(*turn.scan, turn.woke);
    Add(DriveFigure::kTurn, Microseconds(turn.sent - turn.woke));
    AddLatency(DriveFigure::kScanLatency, turn.scan_latency);
    spent = SeekEnd();
  }
  if (epoch_ == kNoEpoch) return spent;
  AddLatency(DriveFigure::kBeaconLatency, turn.beacon_latency);
  if (turn.evidence.oldest_beacon) {
    // By the brain's count the tick that every decision is behind is no age.
    const Nanoseconds age = *turn.evidence.oldest_beacon + options_.tick_period;
    Add(DriveFigure::kBeaconAge, Microseconds(age));
  }
  SeekBegin(turn);
  return spent;
}

DriveFigures DriveTiming::Figures() const {
  DriveFigures figures;
  for (std::size_t i = 0; i < kDriveFigures; ++i) {
    figures.figures[i] = figures_[i].Summary();
  }
  figures.narrowest = narrowest_;
  figures.budget_spent = budget_spent_;
  figures.received_before_sent = received_before_sent_;
  return figures;
}

}  // namespace giveway
