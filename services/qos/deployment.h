// What a set of profiles is held against: the topics of the fleet, how large it is, how often it
// speaks, and what surrounds its processes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "services/qos/profile_set.h"

namespace giveway::qos {

// What the kernel charges a receive buffer for a small datagram.
inline constexpr std::int64_t kDatagramBytes = 1024;

// What the samples of a topic are distinguished by; says how many instances an endpoint holds.
enum class Keyed : std::uint8_t { kNot, kByVehicle, kByVehicleReaderOne, kBySignal };

struct Topic {
  std::string_view name;
  std::string_view stem;        // of its profiles: stem_writer, stem_reader
  std::string_view written_in;  // partition of the writers: "<area>/v<id>"
  std::string_view read_in;     // partition of the readers
  Keyed keyed = Keyed::kByVehicle;
  int ticks = 0;                  // between two samples of an instance; 0: no fixed rate
  bool guarded = false;           // a reader must learn that it fell silent
  bool lively = false;            // and by liveliness, too
  bool late_joiners = false;      // late joiners must receive it
  std::int64_t reader_depth = 1;  // less overwrites samples a reader counts on
};

std::span<const Topic> FleetTopics();
// Null if the fleet has no such topic.
const Topic* TopicOfProfile(std::string_view profile);

// Above so many vehicles code announces participants every 5 s, whatever the profile says.
inline constexpr std::int64_t kLargeFleet = 32;
inline constexpr std::int64_t kLargeFleetAnnouncementNs = 5'000'000'000;

// Participants besides the vehicles: the world and an observer.
inline constexpr std::int64_t kOtherParticipants = 2;

struct Deployment {
  std::int64_t vehicles = 2;
  std::int64_t vehicles_a_host = 0;  // that share ports; 0: all of them
  std::int64_t signals = 0;
  std::int64_t tick_ns = 50'000'000;
  // Sets must be complete; false for a file that is only part of one.
  bool complete = true;
  std::vector<std::string> environment;   // NAME=value of the processes
  std::vector<std::string> folder_files;  // names of files in their working folder
};

// The instances a writer or reader of a topic holds.
std::int64_t Instances(const Topic& topic, Owner owner, const Deployment& deployment);
// Nanoseconds between two samples of an instance; 0: no fixed rate.
std::int64_t Period(const Topic& topic, const Deployment& deployment);

}  // namespace giveway::qos
