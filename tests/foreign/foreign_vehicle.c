/* A whole vehicle by another vendor's DDS, in C: joins a world, drives straight to its goal, and
 * gives way at crossings by the contract of idl/FOREIGN.md, of which it is the test. It knows the
 * fleet by fleet.idl and that contract alone: nothing of ours is included or linked.
 *
 *   foreign_vehicle DOMAIN ID CRUISE_M_S GOAL_X_M GOAL_Y_M [FAULT]
 *
 * FAULT breaks the contract on purpose: never-grants, floors-bucket, volatile-join, no-partition.
 * Exit code: 0 the run ended or SIGTERM, 1 the world does not answer, 2 it refuses. */
#include <dds/dds.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fleet.h"
#include "tests/foreign/crossing.h"
#include "tests/foreign/endpoints.h"

typedef giveway_wire_Beacon Beacon;
typedef giveway_wire_RangeScan Scan;
typedef giveway_wire_Roster Roster;

enum { kMostPeers = 32, kFirstFrontSensor = 3, kLastFrontSensor = 4 };

static const double kWheelRadius_m = 0.0975;
static const double kAxle_m = 0.33;
static const double kBodyRadius_m = 0.25;
static const double kAcceleration_m_s2 = 0.3;
static const double kDeceleration_m_s2 = 0.6;
static const double kArrives_m = 0.05;
static const double kKeepsFromEchoes_m = 0.45;
static const int64_t kBeaconAgeLimit_ns = 200000000;
static const int64_t kScanWait_ns = 75000000; /* half a tick more than a scan should take */
static const int64_t kScanAgeLimit_ns = 200000000;
static const double kTick_s = 0.05;

struct peer {
  uint32_t id;
  int64_t received_ns; /* by the own clock: nothing that is sent says how old it is */
  Beacon beacon;
  bool stands_back; /* its path crosses the own one, and this vehicle holds before it */
};

static struct vehicle {
  uint32_t id;
  double cruise_m_s;
  struct point goal;
  const char* fault;
  struct endpoints dds;
  uint32_t session[4], world_epoch;
  Scan scan; /* the newest; tick 0: none yet */
  int64_t scanned_ns;
  bool blind; /* none came for kScanAgeLimit_ns */
  double x_m, y_m, heading_rad, gone_m;
  double counted_left_rad, counted_right_rad; /* up to where the pose is */
  bool arrived, ended;
  uint32_t boot_epoch, seq;
  giveway_wire_DriveRule rule, said_rule;
  uint32_t gives_way_to;
  struct peer peers[kMostPeers];
} me;

static volatile sig_atomic_t stop;
static void OnStop(int number) {
  (void)number;
  stop = 1;
}

static bool Has(const char* fault) { return strcmp(me.fault, fault) == 0; }

static int64_t Now(void) { return dds_time(); }

static uint32_t Random32(void) {
  uint32_t number = 0;
  FILE* source = fopen("/dev/urandom", "rb");
  while (number == 0 && source != NULL && fread(&number, sizeof number, 1, source) == 1) {
  }
  if (source != NULL) fclose(source);
  return number;
}

/* ---- joining ------------------------------------------------------------------------------- */

static void AskToJoin(bool leaving) {
  giveway_wire_Join join = {.wanted = me.id, .leaving = leaving};
  memcpy(join.session, me.session, sizeof join.session);
  dds_write(me.dds.join_writer, &join);
}

/* The newest answer to this session; false if there is none. */
static bool TakeRoster(Roster* answer) {
  Roster entry;
  void* at = &entry;
  dds_sample_info_t info;
  bool found = false;
  while (dds_take(me.dds.roster_reader, &at, &info, 1, 1) == 1) {
    if (!info.valid_data || memcmp(entry.session, me.session, sizeof me.session) != 0) continue;
    *answer = entry;
    found = true;
  }
  return found;
}

static void Enter(const Roster* place) {
  me.world_epoch = place->world_epoch;
  me.x_m = place->start_world.x_m;
  me.y_m = place->start_world.y_m;
  me.heading_rad = place->start_world.heading_rad;
  me.counted_left_rad = place->counted_left_rad;
  me.counted_right_rad = place->counted_right_rad;
  fprintf(stderr, "joined as %u at (%.2f, %.2f)\n", place->vehicle, me.x_m, me.y_m);
}

/* Asks once a second: a world forgets a vehicle that waits without asking. */
static int Join(void) {
  const int64_t give_up = Now() + DDS_SECS(30);
  int64_t again = 0;
  Roster answer;
  while (Now() < give_up && !stop) {
    if (Now() >= again) {
      AskToJoin(false);
      again = Now() + DDS_SECS(1);
    }
    if (TakeRoster(&answer)) {
      if (answer.accepted) {
        Enter(&answer);
        return 0;
      }
      fprintf(stderr, "%s: %s\n", answer.waiting ? "waits" : "refused", answer.reason);
      if (!answer.waiting) return 2;
    }
    dds_sleepfor(DDS_MSECS(20));
  }
  fprintf(stderr, "no answer from a world\n");
  return 1;
}

/* ---- what comes in -------------------------------------------------------------------------- */

static void TakeScan(void) {
  Scan scan;
  void* at = &scan;
  dds_sample_info_t info;
  bool came = false;
  while (dds_take(me.dds.ranges_reader, &at, &info, 1, 1) == 1) {
    if (!info.valid_data || scan.vehicle != me.id) continue;
    /* The pose is of this epoch. */
    if (scan.world_epoch != me.world_epoch || scan.tick <= me.scan.tick) continue;
    me.scan = scan;
    me.scanned_ns = Now();
    came = true;
  }
  me.blind = Now() - me.scanned_ns > kScanAgeLimit_ns;
  if (!came) return;
  /* The encoders count on through scans that were lost. */
  const double left_m = (me.scan.counted_left_rad - me.counted_left_rad) * kWheelRadius_m;
  const double right_m = (me.scan.counted_right_rad - me.counted_right_rad) * kWheelRadius_m;
  me.counted_left_rad = me.scan.counted_left_rad;
  me.counted_right_rad = me.scan.counted_right_rad;
  const double turned_rad = (right_m - left_m) / kAxle_m;
  const double forward_m = (left_m + right_m) / 2;
  me.x_m += forward_m * cos(me.heading_rad + turned_rad / 2);
  me.y_m += forward_m * sin(me.heading_rad + turned_rad / 2);
  me.heading_rad = remainder(me.heading_rad + turned_rad, 2 * M_PI);
  me.gone_m += fabs(forward_m);
}

static struct peer* PeerOf(uint32_t id) {
  struct peer* oldest = &me.peers[0];
  for (int i = 0; i < kMostPeers; ++i) {
    if (me.peers[i].id == id) return &me.peers[i];
    if (me.peers[i].received_ns < oldest->received_ns) oldest = &me.peers[i];
  }
  memset(oldest, 0, sizeof *oldest);
  oldest->id = id;
  return oldest;
}

/* Accepted: intact, of this world, and newer than the last one of this life of the peer. */
static void TakeBeacons(void) {
  Beacon beacon;
  void* at = &beacon;
  dds_sample_info_t info;
  while (dds_take(me.dds.beacon_reader, &at, &info, 1, 1) == 1) {
    if (!info.valid_data || beacon.vehicle == 0 || beacon.vehicle == me.id) continue;
    if (beacon.crc != BeaconCrc(&beacon) || beacon.world_epoch != me.scan.world_epoch) continue;
    struct peer* peer = PeerOf(beacon.vehicle);
    const bool same_life = peer->beacon.boot_epoch == beacon.boot_epoch;
    if (same_life && beacon.seq <= peer->beacon.seq) continue;
    peer->beacon = beacon;
    peer->received_ns = Now();
  }
}

/* ---- deciding ------------------------------------------------------------------------------- */

static double SpeedOf(const Scan* scan) {
  return (scan->left_rad_s + scan->right_rad_s) / 2 * kWheelRadius_m;
}

/* To stand still from the present speed: two ticks until a command acts, one more as a reserve. */
static double StoppingDistance(void) {
  const double speed = fmax(0, SpeedOf(&me.scan));
  return speed * 3 * kTick_s + speed * speed / (2 * kDeceleration_m_s2) + 0.05;
}

static struct priority_key OwnKey(void) {
  const double steps = me.cruise_m_s / 0.05;
  const double bucket = Has("floors-bucket") ? floor(steps - 1e-9) : floor(steps + 0.5);
  return (struct priority_key){0, (uint32_t)bucket, me.id};
}

/* A peer that will not move by itself stays where it is, and right of way does not apply to it. */
static bool StaysPut(const Beacon* beacon) {
  return beacon->rule == giveway_wire_RULE_ARRIVED || beacon->rule == giveway_wire_RULE_NOT_RUNNING;
}

static double Sigma(const Beacon* beacon) {
  return sqrt(fmax(0, beacon->covariance.xx_m2 + beacon->covariance.yy_m2));
}

/* What this peer allows: how far the own centre may advance, huge if there is no conflict. */
static double MayGo(struct peer* peer) {
  const double kFar_m = 1e6;
  const Beacon* beacon = &peer->beacon;
  if (peer->id == 0 || beacon->mode == giveway_wire_MODE_LEAVING) return kFar_m;
  const bool fresh = Now() - peer->received_ns <= kBeaconAgeLimit_ns;
  const struct path own = {{me.x_m, me.y_m}, me.goal};
  const struct path theirs = {{beacon->world_from_body.x_m, beacon->world_from_body.y_m},
                              {beacon->toward_x_m, beacon->toward_y_m}};
  const double reach_m = kBodyRadius_m + beacon->body_radius_m + 0.2 + 2 * Sigma(beacon);
  const struct stretch crossing = CrossingOf(own, theirs, reach_m);
  if (!crossing.exists) {
    peer->stands_back = false;
    return kFar_m;
  }
  const double before_m = crossing.begin_m - StoppingDistance();
  const bool can_stop = crossing.begin_m > 0 && before_m > -0.1;
  const bool has_priority =
      HasPriority((struct priority_key){beacon->order_waited_ticks, beacon->order_speed_bucket,
                                        beacon->order_vehicle},
                  peer->id, OwnKey(), me.id);
  if (Has("never-grants"))
    return can_stop && !StaysPut(beacon) && has_priority ? crossing.begin_m : kFar_m;
  const bool grants = fresh && (beacon->gives_way_to == me.id || StaysPut(beacon));
  if (has_priority && can_stop && fresh) {
    me.gives_way_to = peer->id;
    me.rule = giveway_wire_RULE_GIVE_WAY;
    peer->stands_back = true;
    return crossing.begin_m;
  }
  if (grants || !can_stop) return kFar_m; /* in the crossing, driving on is how it gets out */
  me.rule = fresh ? giveway_wire_RULE_NOT_GRANTED : giveway_wire_RULE_PEER_LOST;
  return crossing.begin_m;
}

static bool SeesSomethingAhead(void) {
  for (int i = kFirstFrontSensor; i <= kLastFrontSensor; ++i) {
    if (me.scan.echo[i] == giveway_wire_ECHO_HEARD && me.scan.range_m[i] < kKeepsFromEchoes_m) {
      return true;
    }
  }
  return false;
}

/* The speed to drive at, and why. */
static double Decide(void) {
  const double left_m = hypot(me.goal.x_m - me.x_m, me.goal.y_m - me.y_m);
  double free_m = left_m;
  me.gives_way_to = 0;
  me.rule = giveway_wire_RULE_CRUISE;
  for (int i = 0; i < kMostPeers; ++i) free_m = fmin(free_m, MayGo(&me.peers[i]) - 0.05);
  if (left_m < kArrives_m) me.arrived = true;
  double speed = me.cruise_m_s;
  const double room_m = fmax(0, free_m - 3 * kTick_s * fmax(0, SpeedOf(&me.scan)));
  speed = fmin(speed, sqrt(2 * 0.8 * kDeceleration_m_s2 * room_m));
  if (SeesSomethingAhead()) {
    speed = 0;
    if (me.rule == giveway_wire_RULE_CRUISE) me.rule = giveway_wire_RULE_OBSTACLE;
  }
  if (me.arrived) me.rule = giveway_wire_RULE_ARRIVED;
  if (me.blind) me.rule = giveway_wire_RULE_RANGES_STALE;
  if (me.scan.run_state != giveway_wire_RUN_RUNNING) me.rule = giveway_wire_RULE_NOT_RUNNING;
  if (stop) me.rule = giveway_wire_RULE_LEAVING;
  const bool stands = me.arrived || me.blind || stop || me.rule == giveway_wire_RULE_NOT_RUNNING;
  if (stands) me.gives_way_to = 0;
  return stands ? 0 : speed;
}

/* ---- what goes out -------------------------------------------------------------------------- */

static giveway_wire_DriveMode Mode(void) {
  if (stop) return giveway_wire_MODE_LEAVING;
  return me.blind ? giveway_wire_MODE_HALT : giveway_wire_MODE_COOPERATIVE;
}

static void SendCommand(double speed) {
  const double bearing_rad = atan2(me.goal.y_m - me.y_m, me.goal.x_m - me.x_m);
  const double off_rad = remainder(bearing_rad - me.heading_rad, 2 * M_PI);
  const double turn_rad_s = speed > 0 ? fmax(-0.5, fmin(0.5, 1.5 * off_rad)) : 0;
  dds_subscription_matched_status_t matched = {0};
  dds_get_subscription_matched_status(me.dds.beacon_reader, &matched);
  giveway_wire_MotorCommand command = {
      .vehicle = me.id,
      .world_epoch = me.scan.world_epoch,
      .tick = me.scan.tick,
      .left_rad_s = (speed - turn_rad_s * kAxle_m / 2) / kWheelRadius_m,
      .right_rad_s = (speed + turn_rad_s * kAxle_m / 2) / kWheelRadius_m,
      .decision = {.mode = Mode(), .rule = me.rule, .peer = me.gives_way_to, .sensor = -1},
      .decision_changed = me.rule != me.said_rule,
      .matched_peers = matched.current_count};
  dds_write(me.dds.command_writer, &command);
}

static void SendBeacon(void) {
  const double sigma_m = 0.01 + 0.01 * me.gone_m;
  const double sigma_rad = 0.01;
  const struct priority_key key = OwnKey();
  const bool stays = me.arrived || me.rule == giveway_wire_RULE_NOT_RUNNING;
  Beacon beacon = {.vehicle = me.id,
                   .boot_epoch = me.boot_epoch,
                   .seq = ++me.seq,
                   .world_epoch = me.scan.world_epoch,
                   .tick = me.scan.tick,
                   .left_rad_s = me.scan.left_rad_s,
                   .right_rad_s = me.scan.right_rad_s,
                   .cruise_m_s = me.cruise_m_s,
                   .world_from_body = {me.x_m, me.y_m, me.heading_rad},
                   .covariance = {.xx_m2 = sigma_m * sigma_m,
                                  .yy_m2 = sigma_m * sigma_m,
                                  .hh_rad2 = sigma_rad * sigma_rad},
                   .body_radius_m = kBodyRadius_m,
                   .wheel_radius_m = kWheelRadius_m,
                   .axle_m = kAxle_m,
                   .acceleration_m_s2 = kAcceleration_m_s2,
                   .deceleration_m_s2 = kDeceleration_m_s2,
                   .toward_x_m = stays ? me.x_m : me.goal.x_m,
                   .toward_y_m = stays ? me.y_m : me.goal.y_m,
                   .mode = Mode(),
                   .rule = me.rule,
                   .gives_way_to = Has("never-grants") ? 0 : me.gives_way_to,
                   .order_waited_ticks = key.waited_ticks,
                   .order_speed_bucket = key.speed_bucket,
                   .order_vehicle = key.vehicle};
  beacon.crc = BeaconCrc(&beacon);
  dds_write(me.dds.beacon_writer, &beacon);
}

static void Turn(void) {
  dds_attach_t woken;
  dds_waitset_wait(me.dds.scan_wait, &woken, 1, stop ? 0 : kScanWait_ns);
  Roster news;
  if (TakeRoster(&news)) me.ended = !news.accepted || news.run_state == giveway_wire_RUN_ENDED;
  TakeScan();
  TakeBeacons();
  const double speed = Decide();
  if (me.scan.tick == 0) return;
  SendCommand(speed);
  SendBeacon();
  if (me.rule != me.said_rule) fprintf(stderr, "rule %d for %u\n", me.rule, me.gives_way_to);
  me.said_rule = me.rule;
}

int main(int argc, char** argv) {
  if (argc < 6) {
    fprintf(stderr, "usage: %s DOMAIN ID CRUISE_M_S GOAL_X_M GOAL_Y_M [FAULT]\n", argv[0]);
    return 2;
  }
  me.id = (uint32_t)strtoul(argv[2], NULL, 10);
  me.cruise_m_s = strtod(argv[3], NULL);
  me.goal = (struct point){strtod(argv[4], NULL), strtod(argv[5], NULL)};
  me.fault = argc > 6 ? argv[6] : "";
  me.boot_epoch = Random32();
  me.said_rule = giveway_wire_RULE_LEAVING;
  for (int i = 0; i < 4; ++i) me.session[i] = Random32();
  signal(SIGTERM, OnStop);
  signal(SIGINT, OnStop);
  MakeJoinEndpoints(&me.dds, (uint32_t)strtoul(argv[1], NULL, 10), Has("volatile-join"),
                    Has("no-partition"));
  const int exit_code = Join();
  if (exit_code == 0) {
    MakeOwnEndpoints(&me.dds, me.id);
    while (!stop && !me.ended) Turn();
    for (int i = 0; stop && i < 3; ++i) Turn(); /* best effort: one may be lost */
  }
  if (stop) AskToJoin(true);
  dds_sleepfor(DDS_MSECS(100));
  dds_delete(me.dds.participant);
  return exit_code;
}
