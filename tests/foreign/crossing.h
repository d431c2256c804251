/* What two vehicles must agree on at a crossing, by idl/FOREIGN.md: the checksum, the priority,
 * and where their paths come too near. Pure. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "fleet.h"

struct point {
  double x_m, y_m;
};

struct path { /* straight */
  struct point from, to;
};

struct stretch { /* of the own path, from its start */
  bool exists;
  double begin_m, end_m;
};

struct priority_key {
  uint32_t waited_ticks, speed_bucket, vehicle;
};

/* The CRC-32C that fleet.idl asks for. */
uint32_t BeaconCrc(const giveway_wire_Beacon* beacon);

/* True if `a`, which vehicle id_a acts by, goes before `b`. */
bool HasPriority(struct priority_key a, uint32_t id_a, struct priority_key b, uint32_t id_b);

/* Where the own path is nearer than reach_m to any point of the other one. */
struct stretch CrossingOf(struct path own, struct path other, double reach_m);
