/* The endpoints of a whole vehicle, with the partitions and QoS of idl/FOREIGN.md. */
#pragma once

#include <dds/dds.h>
#include <stdbool.h>
#include <stdint.h>

struct endpoints {
  dds_entity_t participant;
  dds_entity_t join_writer, roster_reader;   /* before it has an id */
  dds_entity_t beacon_writer, beacon_reader; /* named after the id, here and below */
  dds_entity_t command_writer, ranges_reader, scan_wait;
};

/* On the loopback interface. Both faults on purpose: a join that no world takes. Ends the process
 * where something cannot be made. */
void MakeJoinEndpoints(struct endpoints* all, uint32_t domain, bool volatile_join,
                       bool without_partition);
void MakeOwnEndpoints(struct endpoints* all, uint32_t id);
