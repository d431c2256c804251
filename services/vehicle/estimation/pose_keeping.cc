#include "services/vehicle/estimation/pose_keeping.h"

#include <algorithm>
#include <optional>

#include "services/types/fleet_limits.h"
#include "services/types/math/math.h"
#include "services/vehicle/estimation/scan_check.h"

namespace giveway {
namespace {

// A vehicle that is fitted with fixes does not take its encoders for exact, whatever its profile
// says: their errors would never be noticed. Share of a wheel's speed, each tick by itself; over a
// second at 0.4 m/s 9 mm and 2 degrees.
constexpr double kLeastWheelError = 0.1;
// One in a thousand true fixes is further off, by its own deviation and the pose's: chi-square of
// two numbers, and of one.
constexpr double kGate = 13.8;
constexpr double kHeadingGate = 10.8;
// So many that do not fit must agree, one after the other, before they are believed against the
// wheels. Where every second fix is off by 8 sigma to any side, one in ten is, and agrees with the
// one before: five in a row came once in some 270 vehicle-hours of everything.textproto; eight are
// a thousand times as rare.
constexpr std::uint32_t kAgreeing = 8;
// The weight of the newest fix in the share of wrong ones; and what that share is taken for at
// least: a pose can have been unsure for so long that any fix fits.
constexpr double kShareOfOne = 0.125;
constexpr double kSomeWrong = 0.03;
// How much of what fixes say may have come by turning wrongly.
constexpr double kDoubtedHeading_rad = 0.3;
// It slows down from this share of its limit on; after having been lost it resumes below this one.
constexpr double kUnsureFrom = 0.6;
constexpr double kFoundFrom = 0.75;
// It drives no slower than this share of its cruise speed up to the limit, so that it gets there.
constexpr double kSlowest = 0.2;

struct Innovation {
  Vec2 off_world;
  double off_rad = 0;
  double position_m2 = 0;  // variance of the fix, carried on to now
  double heading_rad2 = 0;
  bool of_heading = false;
};

// Squared distance in standard deviations, of the position.
double Mahalanobis(Vec2 off, const PoseCovariance& c, double variance_m2) {
  const double xx = c.xx_m2 + variance_m2;
  const double yy = c.yy_m2 + variance_m2;
  const double determinant = xx * yy - c.xy_m2 * c.xy_m2;
  return (yy * off.x * off.x - 2 * c.xy_m2 * off.x * off.y + xx * off.y * off.y) / determinant;
}

// Somewhere in a world, and within what can be squared and divided by; false of NaN.
bool IsUsable(const PoseFix& fix, const FixTaker& taker) {
  const Pose& pose = fix.world_from_body;
  return fix.vehicle == taker.vehicle && fix.epoch == taker.epoch && fix.tick != kNoTick &&
         IsBetween(pose.position_world.x, -kMaxCoordinate_m, kMaxCoordinate_m) &&
         IsBetween(pose.position_world.y, -kMaxCoordinate_m, kMaxCoordinate_m) &&
         IsBetween(pose.heading_rad, -2 * kPi, 2 * kPi) &&
         IsBetween(fix.sigma_position_m, kLeastFixSigma_m, kMostFixSigma_m) &&
         (fix.sigma_heading_rad == 0 ||
          IsBetween(fix.sigma_heading_rad, kLeastFixSigma_rad, 2 * kPi));
}

// What was driven since the fix is known but for the heading it was driven by.
std::optional<Innovation> InnovationOf(const PoseFix& fix, const Odometry& odometry,
                                       const PoseKeeping& keeping) {
  const PastPose& past = keeping.past[Number(fix.tick) % kPastPoses];
  if (past.tick != fix.tick) return std::nullopt;
  const double since_m = Norm(odometry.WorldFromBody().position_world - past.position_world);
  const double turned_by_m = since_m * SigmaHeading(odometry.Covariance());
  return Innovation{
      .off_world = fix.world_from_body.position_world - past.position_world,
      .off_rad = WrapAngle(fix.world_from_body.heading_rad - past.heading_rad),
      .position_m2 = fix.sigma_position_m * fix.sigma_position_m + turned_by_m * turned_by_m,
      .heading_rad2 = fix.sigma_heading_rad * fix.sigma_heading_rad,
      .of_heading = fix.sigma_heading_rad > 0};
}

double SquaredHeadingOff(const Innovation& innovation, const Odometry& odometry) {
  return innovation.off_rad * innovation.off_rad /
         (odometry.Covariance().hh_rad2 + innovation.heading_rad2);
}

bool Fits(const Innovation& innovation, const Odometry& odometry) {
  const PoseCovariance c = odometry.Covariance();
  if (!(Mahalanobis(innovation.off_world, c, innovation.position_m2) <= kGate)) return false;
  return !innovation.of_heading || SquaredHeadingOff(innovation, odometry) <= kHeadingGate;
}

// The share of wrong ones is by the newest, each by how probably it was wrong.
void CountWrong(double probability, PoseKeeping* keeping) {
  keeping->wrong_share += kShareOfOne * (probability - keeping->wrong_share);
}

// What is known of a sensor grows old with every fix that does not come, until either is as likely:
// it did not work, and may not yet.
void Forget(const PoseFix& fix, const PoseFixModel& fitted, const FixTaker& taker,
            PoseKeeping* keeping) {
  constexpr double kUnknown = 0.5;  // share of wrong ones: either is as likely
  const double known_for_s = TicksBetween(keeping->agreed, fix.tick) * taker.tick_s;
  const double missing = std::max(0.0, known_for_s / fitted.every_s - 1);
  const double forgotten = 1 - Exp(missing * Log(1 - kShareOfOne));
  keeping->wrong_share = std::max(keeping->wrong_share, kUnknown * forgotten);
}

// A fix that fits may still be one that came off a wall: by chance, or because the pose is unsure
// or wrong itself. With which probability it is right: right ones lie about the pose as a normal
// distribution, wrong ones anywhere within the gate. The factors, kGate / 2 and kOfWidth, are the
// gate's area and width, in deviations, times the density in the middle.
double ProbablyRight(const Innovation& innovation, double wrong_share, const Odometry& odometry) {
  constexpr double kOfWidth = 2.62;  // 2 sqrt(kHeadingGate) / sqrt(2 pi)
  const double wrong = std::max(kSomeWrong, wrong_share);
  double right =
      (1 - wrong) * (kGate / 2) *
      Exp(-Mahalanobis(innovation.off_world, odometry.Covariance(), innovation.position_m2) / 2);
  if (innovation.of_heading) right *= kOfWidth * Exp(-SquaredHeadingOff(innovation, odometry) / 2);
  return right / (right + wrong);
}

void Correct(const Innovation& innovation, double probability, PoseFilter* filter,
             Odometry* odometry, PoseKeeping* keeping) {
  const PoseFilter before = *filter;
  filter->Measure(PoseNumber::kX, innovation.off_world.x, innovation.position_m2);
  filter->Measure(PoseNumber::kY, innovation.off_world.y, innovation.position_m2);
  if (innovation.of_heading) {
    filter->Measure(PoseNumber::kHeading, innovation.off_rad, innovation.heading_rad2);
  }
  filter->MixWith(before, probability);
  *odometry = filter->TheOdometry();
  keeping->calibration = filter->TheCalibration();
  for (PastPose& past : keeping->past) {
    past.position_world = past.position_world + filter->Moved();
    past.heading_rad = WrapAngle(past.heading_rad + filter->Rotated());
  }
}

void Believe(const Innovation& innovation, Tick tick, double probability, Odometry* odometry,
             PoseKeeping* keeping) {
  PoseFilter filter(*odometry, keeping->calibration);
  Correct(innovation, probability, &filter, odometry, keeping);
  keeping->agreed = tick;
  keeping->disagreement = {};
  ++keeping->fixes_used;
}

// As many as must agree cannot all be wrong.
void BelieveAgainstWheels(const Innovation& innovation, Tick tick, Odometry* odometry,
                          PoseKeeping* keeping) {
  PoseFilter filter(*odometry, keeping->calibration);
  const double off_rad = innovation.of_heading ? Magnitude(innovation.off_rad) : 0;
  filter.Doubt(innovation.off_world, std::max(kDoubtedHeading_rad, off_rad));
  *odometry = filter.TheOdometry();
  keeping->calibration = filter.TheCalibration();
  Believe(innovation, tick, 1, odometry, keeping);
}

// No wheels, however wrong their encoders, can have brought it there since a fix fitted last.
bool IsOutOfReach(const Innovation& innovation, const RobotModel& profile, const FixTaker& taker,
                  const Odometry& odometry, const PoseKeeping& keeping) {
  constexpr double kSigmasOff = 4;
  const double driven_m =
      profile.max_speed_m_s * TicksBetween(keeping.agreed, taker.tick) * taker.tick_s;
  const double unsure_m =
      kSigmasOff * (SigmaPosition(odometry.Covariance()) + Sqrt(innovation.position_m2));
  return Norm(innovation.off_world) > 2 * driven_m + unsure_m;
}

// Says about the same as those before it that did not fit.
bool AgreesWith(const Disagreement& disagreement, const Innovation& innovation) {
  const Vec2 between = innovation.off_world - disagreement.off_world;
  if (!(SquaredNorm(between) <= kGate * 2 * innovation.position_m2)) return false;
  const double turned_rad = WrapAngle(innovation.off_rad - disagreement.off_rad);
  return !innovation.of_heading ||
         turned_rad * turned_rad <= kHeadingGate * 2 * innovation.heading_rad2;
}

// One that does not fit may be wrong, or all before it. Which, only further ones can say; until
// then both may be.
void Weigh(const PoseFix& fix, const RobotModel& profile, const FixTaker& taker, Odometry* odometry,
           PoseKeeping* keeping) {
  const auto innovation = InnovationOf(fix, *odometry, *keeping);
  if (!IsUsable(fix, taker) || fix.tick <= keeping->agreed || !innovation) {
    ++keeping->fixes_refused;
    return;
  }
  Forget(fix, profile.pose_fix, taker, keeping);
  if (Fits(*innovation, *odometry)) {
    const double right = ProbablyRight(*innovation, keeping->wrong_share, *odometry);
    Believe(*innovation, fix.tick, right, odometry, keeping);
    CountWrong(1 - right, keeping);
    return;
  }
  ++keeping->fixes_refused;
  CountWrong(1, keeping);
  if (IsOutOfReach(*innovation, profile, taker, *odometry, *keeping)) return;
  Disagreement& disagreement = keeping->disagreement;
  const std::uint32_t agreeing = AgreesWith(disagreement, *innovation) ? disagreement.fixes : 0;
  disagreement = {innovation->off_world, innovation->of_heading ? innovation->off_rad : 0,
                  agreeing + 1};
  if (disagreement.fixes < kAgreeing) return;
  --keeping->fixes_refused;
  BelieveAgainstWheels(*innovation, fix.tick, odometry, keeping);
}

}  // namespace

bool KeepsPose(const RobotModel& profile) {
  return profile.pose_fix.Fitted() || profile.wheel_error.Any() || profile.pose_limit_m > 0;
}

// The magnitude of the wheel errors is known, not their sign: only the squares are used.
void Begin(const RobotModel& profile, PoseKeeping* keeping) {
  *keeping = {.fixes_used = keeping->fixes_used, .fixes_refused = keeping->fixes_refused};
  const WheelErrors& may_be = profile.wheel_error;
  keeping->calibration.own = {may_be.diameter * may_be.diameter, 0, may_be.axle * may_be.axle};
}

PoseCovariance Roll(const RobotModel& profile, const Rolling& rolling, Odometry* odometry,
                    PoseKeeping* keeping) {
  const Calibration& calibration = keeping->calibration;
  const WheelSpeeds wheels = profile.wheel_error.Any()
                                 ? AsNominal(profile.drive, calibration.wheels, rolling.wheels)
                                 : rolling.wheels;
  const double error = profile.pose_fix.Fitted() ? std::max(rolling.wheel_error, kLeastWheelError)
                                                 : rolling.wheel_error;
  const Vec2 from_world = odometry->WorldFromBody().position_world;
  const Vec2 forward_world = odometry->ForwardWorld();
  const PoseCovariance added =
      odometry->Roll(profile.drive, wheels, rolling.dt_s, error, rolling.guessed_m);
  if (profile.wheel_error.Any()) {
    const double rim_m = profile.drive.wheel_radius_m * rolling.dt_s;
    PoseFilter filter(*odometry, calibration);
    filter.Carry(odometry->WorldFromBody().position_world - from_world, forward_world,
                 rim_m * wheels.left_rad_s, rim_m * wheels.right_rad_s, profile.drive.axle_m);
    *odometry = filter.TheOdometry();
    keeping->calibration = filter.TheCalibration();
  }
  if (!profile.pose_fix.Fitted()) return added;
  const Pose& now = odometry->WorldFromBody();
  keeping->past[Number(rolling.tick) % kPastPoses] = {rolling.tick, now.position_world,
                                                      now.heading_rad};
  if (keeping->agreed == kNoTick) keeping->agreed = rolling.tick;
  return added;
}

void Take(const PoseFix& fix, const RobotModel& profile, const FixTaker& taker, Odometry* odometry,
          PoseKeeping* keeping) {
  if (!profile.pose_fix.Fitted()) {
    ++keeping->fixes_refused;
  } else if (fix.tick >= taker.tick && IsUsable(fix, taker)) {
    keeping->waiting = fix;
  } else {
    Weigh(fix, profile, taker, odometry, keeping);
  }
}

void TakeWaiting(const RobotModel& profile, const FixTaker& taker, Odometry* odometry,
                 PoseKeeping* keeping) {
  if (keeping->waiting.tick == kNoTick || keeping->waiting.tick >= taker.tick) return;
  const PoseFix fix = keeping->waiting;
  keeping->waiting = {};
  if (fix.epoch == taker.epoch) Weigh(fix, profile, taker, odometry, keeping);
}

PoseCovariance PromisedCovariance(const Odometry& odometry, const PoseKeeping& keeping) {
  PoseCovariance promised = odometry.Covariance();
  if (keeping.disagreement.fixes == 0) return promised;
  const Vec2 off = keeping.disagreement.off_world;
  promised.xx_m2 += off.x * off.x;
  promised.xy_m2 += off.x * off.y;
  promised.yy_m2 += off.y * off.y;
  promised.hh_rad2 += keeping.disagreement.off_rad * keeping.disagreement.off_rad;
  return promised;
}

double JudgeCertainty(const RobotModel& profile, const PoseCovariance& promised,
                      PoseKeeping* keeping) {
  if (!(profile.pose_limit_m > 0)) return 1;
  const double share = SigmaPosition(promised) / profile.pose_limit_m;
  keeping->lost = share >= (keeping->lost ? kFoundFrom : 1);
  if (keeping->lost) return 0;
  if (share <= kUnsureFrom) return 1;
  return std::max(kSlowest, (1 - share) / (1 - kUnsureFrom));
}

void AddTo(const PoseKeeping& keeping, StateHash* hash) {
  hash->Add(keeping.calibration.wheels.diameter);
  hash->Add(keeping.calibration.wheels.axle);
  for (const double entry : keeping.calibration.with_pose) hash->Add(entry);
  for (const double entry : keeping.calibration.own) hash->Add(entry);
  hash->Add(keeping.waiting.tick);
  hash->Add(keeping.waiting.world_from_body.position_world.x);
  hash->Add(keeping.waiting.world_from_body.position_world.y);
  hash->Add(keeping.agreed);
  hash->Add(keeping.disagreement.off_world.x);
  hash->Add(keeping.disagreement.off_world.y);
  hash->Add(keeping.disagreement.off_rad);
  hash->Add(keeping.disagreement.fixes);
  hash->Add(keeping.fixes_used);
  hash->Add(keeping.fixes_refused);
  hash->Add(keeping.lost);
  if (keeping.wrong_share != 0) hash->Add(keeping.wrong_share);
}

}  // namespace giveway
