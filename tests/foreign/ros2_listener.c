/* Hears what the observer publishes for ROS 2, as a node of another vendor's DDS does: by the names, types
 * and QoS of ROS 2 alone. Writes a JSON object a message to stdout.
 * Usage: ros2_listener DOMAIN VEHICLE SECONDS */
#include <dds/dds.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ros2.h"
#include "tests/foreign/on_loopback.h"

enum { kTopics = 6, kBatch = 16 };

struct heard {
  const char* name; /* in ROS */
  dds_entity_t reader;
  void (*print)(const void* sample);
};

static void PrintNumber(const char* name, double number) {
  if (isfinite(number)) {
    printf(",\"%s\":%.17g", name, number);
  } else {
    printf(",\"%s\":\"%s\"", name, number > 0 ? "inf" : "other");
  }
}

static void PrintHeader(const std_msgs_msg_dds__Header_* header) {
  printf(",\"frame_id\":\"%s\"", header->frame_id);
  PrintNumber("stamp", header->stamp.sec + 1e-9 * header->stamp.nanosec);
}

static void PrintOdometry(const void* sample) {
  const nav_msgs_msg_dds__Odometry_* odometry = sample;
  PrintHeader(&odometry->header);
  printf(",\"child_frame_id\":\"%s\"", odometry->child_frame_id);
  PrintNumber("x", odometry->pose.pose.position.x);
  PrintNumber("y", odometry->pose.pose.position.y);
  PrintNumber("qz", odometry->pose.pose.orientation.z);
  PrintNumber("qw", odometry->pose.pose.orientation.w);
  PrintNumber("forward", odometry->twist.twist.linear.x);
  PrintNumber("variance_x", odometry->pose.covariance[0]);
}

static void PrintRange(const void* sample) {
  const sensor_msgs_msg_dds__Range_* range = sample;
  PrintHeader(&range->header);
  printf(",\"radiation_type\":%d", range->radiation_type);
  PrintNumber("field_of_view", range->field_of_view);
  PrintNumber("max_range", range->max_range);
  PrintNumber("range", range->range);
}

static void PrintTransforms(const void* sample) {
  const tf2_msgs_msg_dds__TFMessage_* message = sample;
  printf(",\"transforms\":[");
  for (uint32_t i = 0; i < message->transforms._length; ++i) {
    const geometry_msgs_msg_dds__TransformStamped_* one = &message->transforms._buffer[i];
    printf("%s{\"child_frame_id\":\"%s\"", i == 0 ? "" : ",", one->child_frame_id);
    PrintHeader(&one->header);
    PrintNumber("x", one->transform.translation.x);
    printf("}");
  }
  printf("]");
}

static void PrintMarkers(const void* sample) {
  const visualization_msgs_msg_dds__MarkerArray_* message = sample;
  printf(",\"markers\":[");
  for (uint32_t i = 0; i < message->markers._length; ++i) {
    const visualization_msgs_msg_dds__Marker_* one = &message->markers._buffer[i];
    printf("%s{\"id\":%d,\"type\":%d,\"action\":%d,\"ns\":\"%s\"", i == 0 ? "" : ",", one->id,
           one->type, one->action, one->ns);
    PrintHeader(&one->header);
    PrintNumber("x", one->pose.position.x);
    PrintNumber("alpha", one->color.a);
    printf("}");
  }
  printf("]");
}

static void PrintTwist(const void* sample) {
  const geometry_msgs_msg_dds__Twist_* twist = sample;
  PrintNumber("forward", twist->linear.x);
  PrintNumber("turn", twist->angular.z);
}

/* rclcpp's defaults: reliable, volatile, keep last 10; of /tf_static what tf2 asks for. */
static dds_entity_t ReaderOf(dds_entity_t participant, const dds_topic_descriptor_t* type,
                             const char* name) {
  const bool is_static = strcmp(name, "/tf_static") == 0;
  char mangled[64];
  snprintf(mangled, sizeof mangled, "rt%s", name);
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  dds_qset_durability(qos, is_static ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 100);
  const dds_entity_t topic = Made(dds_create_topic(participant, type, mangled, NULL, NULL));
  const dds_entity_t reader = Made(dds_create_reader(participant, topic, qos, NULL));
  dds_delete_qos(qos);
  return reader;
}

static void Drain(const struct heard* heard) {
  void* samples[kBatch] = {NULL};
  dds_sample_info_t infos[kBatch];
  for (;;) {
    const dds_return_t count = dds_take(heard->reader, samples, infos, kBatch, kBatch);
    if (count <= 0) return;
    for (dds_return_t i = 0; i < count; ++i) {
      if (!infos[i].valid_data) continue;
      printf("{\"topic\":\"%s\"", heard->name);
      heard->print(samples[i]);
      printf("}\n");
    }
    dds_return_loan(heard->reader, samples, count);
    memset(samples, 0, sizeof samples);
  }
}

int main(int argc, char** argv) {
  if (argc != 4) {
    fprintf(stderr, "usage: ros2_listener DOMAIN VEHICLE SECONDS\n");
    return 2;
  }
  const uint32_t domain = (uint32_t)strtoul(argv[1], NULL, 10);
  const double seconds = strtod(argv[3], NULL);
  char odom[48], ultrasonics[48], command[48];
  snprintf(odom, sizeof odom, "/giveway/v%s/odom", argv[2]);
  snprintf(ultrasonics, sizeof ultrasonics, "/giveway/v%s/ultrasonics", argv[2]);
  snprintf(command, sizeof command, "/giveway/v%s/cmd_vel", argv[2]);
  const dds_entity_t all = ParticipantOnLoopback(domain);
  const dds_topic_descriptor_t* transforms = &tf2_msgs_msg_dds__TFMessage__desc;
  const struct heard heard[kTopics] = {
      {odom, ReaderOf(all, &nav_msgs_msg_dds__Odometry__desc, odom), PrintOdometry},
      {ultrasonics, ReaderOf(all, &sensor_msgs_msg_dds__Range__desc, ultrasonics), PrintRange},
      {command, ReaderOf(all, &geometry_msgs_msg_dds__Twist__desc, command), PrintTwist},
      {"/tf", ReaderOf(all, transforms, "/tf"), PrintTransforms},
      {"/tf_static", ReaderOf(all, transforms, "/tf_static"), PrintTransforms},
      {"/giveway/markers",
       ReaderOf(all, &visualization_msgs_msg_dds__MarkerArray__desc, "/giveway/markers"),
       PrintMarkers},
  };
  const dds_time_t end = dds_time() + (dds_time_t)(seconds * 1e9);
  while (dds_time() < end) {
    for (int i = 0; i < kTopics; ++i) Drain(&heard[i]);
    fflush(stdout);
    dds_sleepfor(DDS_MSECS(20));
  }
  return dds_delete(all) == DDS_RETCODE_OK ? 0 : 2;
}
