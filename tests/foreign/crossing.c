#include "tests/foreign/crossing.h"

#include <math.h>
#include <string.h>

enum { kBeaconBytes = 200 };

struct packed {
  uint8_t bytes[kBeaconBytes];
  int size;
};

/* This program runs on little-endian machines alone, as the check sum packs. */
static void PutUint(struct packed* to, uint32_t number) {
  memcpy(to->bytes + to->size, &number, sizeof number);
  to->size += (int)sizeof number;
}

static void Real(struct packed* to, double number) {
  memcpy(to->bytes + to->size, &number, sizeof number);
  to->size += (int)sizeof number;
}

uint32_t BeaconCrc(const giveway_wire_Beacon* b) {
  struct packed all = {.size = 0};
  const double reals[] = {
      b->left_rad_s,          b->right_rad_s,         b->cruise_m_s,
      b->world_from_body.x_m, b->world_from_body.y_m, b->world_from_body.heading_rad,
      b->covariance.xx_m2,    b->covariance.xy_m2,    b->covariance.yy_m2,
      b->covariance.xh_m_rad, b->covariance.yh_m_rad, b->covariance.hh_rad2,
      b->body_radius_m,       b->wheel_radius_m,      b->axle_m,
      b->acceleration_m_s2,   b->deceleration_m_s2,   b->toward_x_m,
      b->toward_y_m};
  const uint32_t first[] = {b->vehicle, b->boot_epoch, b->seq, b->world_epoch, b->tick};
  const uint32_t last[] = {(uint32_t)b->mode, (uint32_t)b->rule,     b->gives_way_to,
                           b->blocked_by,     b->order_waited_ticks, b->order_speed_bucket,
                           b->order_vehicle};
  for (size_t i = 0; i < sizeof first / sizeof *first; ++i) PutUint(&all, first[i]);
  for (size_t i = 0; i < sizeof reals / sizeof *reals; ++i) Real(&all, reals[i]);
  for (size_t i = 0; i < sizeof last / sizeof *last; ++i) PutUint(&all, last[i]);
  uint32_t crc = 0xffffffffU;
  for (int i = 0; i < all.size; ++i) {
    crc ^= all.bytes[i];
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1U ^ ((crc & 1U) != 0 ? 0x82f63b78U : 0);
  }
  return ~crc;
}

bool HasPriority(struct priority_key a, uint32_t id_a, struct priority_key b, uint32_t id_b) {
  if (a.waited_ticks != b.waited_ticks) return a.waited_ticks > b.waited_ticks;
  if (a.speed_bucket != b.speed_bucket) return a.speed_bucket > b.speed_bucket;
  if (a.vehicle != b.vehicle) return a.vehicle < b.vehicle;
  /* One inherits the key of the other, and blocks it. */
  if (a.vehicle == id_a) return false;
  return b.vehicle == id_b || id_a < id_b;
}

static double Length(struct path path) {
  return hypot(path.to.x_m - path.from.x_m, path.to.y_m - path.from.y_m);
}

static struct point At(struct path path, double along_m) {
  const double length_m = Length(path);
  const double share = length_m > 0 ? along_m / length_m : 0;
  return (struct point){path.from.x_m + share * (path.to.x_m - path.from.x_m),
                        path.from.y_m + share * (path.to.y_m - path.from.y_m)};
}

static double DistanceTo(struct path path, struct point point) {
  const double length_m = Length(path);
  double along_m = 0;
  if (length_m > 0) {
    along_m = ((point.x_m - path.from.x_m) * (path.to.x_m - path.from.x_m) +
               (point.y_m - path.from.y_m) * (path.to.y_m - path.from.y_m)) /
              length_m;
  }
  const struct point nearest = At(path, fmax(0, fmin(length_m, along_m)));
  return hypot(point.x_m - nearest.x_m, point.y_m - nearest.y_m);
}

struct stretch CrossingOf(struct path own, struct path other, double reach_m) {
  const double kStep_m = 0.02;
  struct stretch crossing = {false, 0, 0};
  for (double along_m = 0; along_m <= Length(own); along_m += kStep_m) {
    if (DistanceTo(other, At(own, along_m)) >= reach_m) continue;
    if (!crossing.exists) crossing.begin_m = along_m;
    crossing.exists = true;
    crossing.end_m = along_m;
  }
  return crossing;
}
