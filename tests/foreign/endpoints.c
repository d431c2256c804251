#include "tests/foreign/endpoints.h"

#include <stdio.h>
#include <stdlib.h>

#include "fleet.h"
#include "tests/foreign/on_loopback.h"

/* Written once and kept for late joiners: joins and the roster. */
static dds_qos_t* Kept(void) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
  return qos;
}

/* Every tick, never repeated. */
static dds_qos_t* EveryTick(int64_t deadline_ns) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_durability(qos, DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 4);
  dds_qset_deadline(qos, deadline_ns);
  return qos;
}

/* Only what a writer says itself keeps it alive. */
static dds_qos_t* AliveByItsOwnWord(dds_qos_t* qos) {
  dds_qset_liveliness(qos, DDS_LIVELINESS_MANUAL_BY_TOPIC, DDS_MSECS(250));
  return qos;
}

static dds_qos_t* In(const char* partition) {
  dds_qos_t* qos = dds_create_qos();
  if (partition != NULL) dds_qset_partition1(qos, partition);
  return qos;
}

static dds_entity_t Topic(const struct endpoints* all, const dds_topic_descriptor_t* type,
                          const char* name) {
  return Made(dds_create_topic(all->participant, type, name, NULL, NULL));
}

/* A publisher or subscriber of its own for each: the partition is theirs. Takes both QoS. */
static dds_entity_t Writer(const struct endpoints* all, dds_entity_t topic, dds_qos_t* around,
                           dds_qos_t* qos) {
  const dds_entity_t publisher = Made(dds_create_publisher(all->participant, around, NULL));
  const dds_entity_t writer = Made(dds_create_writer(publisher, topic, qos, NULL));
  dds_delete_qos(around);
  dds_delete_qos(qos);
  return writer;
}

static dds_entity_t Reader(const struct endpoints* all, dds_entity_t topic, dds_qos_t* around,
                           dds_qos_t* qos) {
  const dds_entity_t subscriber = Made(dds_create_subscriber(all->participant, around, NULL));
  const dds_entity_t reader = Made(dds_create_reader(subscriber, topic, qos, NULL));
  dds_delete_qos(around);
  dds_delete_qos(qos);
  return reader;
}

void MakeJoinEndpoints(struct endpoints* all, uint32_t domain, bool volatile_join,
                       bool without_partition) {
  all->participant = ParticipantOnLoopback(domain);
  dds_qos_t* join = Kept();
  if (volatile_join) dds_qset_durability(join, DDS_DURABILITY_VOLATILE);
  all->join_writer = Writer(all, Topic(all, &giveway_wire_Join_desc, "fleet/join"),
                            In(without_partition ? NULL : "fleet"), join);
  all->roster_reader =
      Reader(all, Topic(all, &giveway_wire_Roster_desc, "world/roster"), In("world"), Kept());
}

void MakeOwnEndpoints(struct endpoints* all, uint32_t id) {
  char own[16], beacon[24];
  snprintf(own, sizeof own, "v%u", id);
  snprintf(beacon, sizeof beacon, "main/v%u", id);
  const dds_entity_t beacons = Topic(all, &giveway_wire_Beacon_desc, "fleet/beacon");
  const dds_entity_t commands = Topic(all, &giveway_wire_MotorCommand_desc, "fleet/motor_command");
  const dds_entity_t ranges = Topic(all, &giveway_wire_RangeScan_desc, "world/ranges");
  all->beacon_writer =
      Writer(all, beacons, In(beacon), AliveByItsOwnWord(EveryTick(DDS_MSECS(100))));
  /* matched_peers counts others: the own writer must not match. */
  dds_qos_t* hears = AliveByItsOwnWord(EveryTick(DDS_MSECS(150)));
  dds_qset_ignorelocal(hears, DDS_IGNORELOCAL_PARTICIPANT);
  all->beacon_reader = Reader(all, beacons, In("main/*"), hears);
  all->command_writer = Writer(all, commands, In(own), EveryTick(DDS_MSECS(100)));
  all->ranges_reader = Reader(all, ranges, In(own), AliveByItsOwnWord(EveryTick(DDS_MSECS(150))));
  all->scan_wait = Made(dds_create_waitset(all->participant));
  Made(dds_set_status_mask(all->ranges_reader, DDS_DATA_AVAILABLE_STATUS));
  Made(dds_waitset_attach(all->scan_wait, all->ranges_reader, 0));
}
