// What of a sample was not believed, and why: for the log. The counters have the numbers.
#pragma once

#include <cstdint>
#include <string>

#include "services/types/ids.h"

namespace giveway {

// A field of a sample, as fleet.idl calls it, that holds what it may not.
struct FieldFault {
  const char* field = "";
  double value = 0;
  double least = 0;  // what it may be; the same as `most` where it must be one number
  double most = 0;
};

// "cruise_m_s is 7, must be 0 to 2.5".
std::string Describe(const FieldFault& fault);

struct Refusal {
  const char* sample = "";         // "beacon", "motor command", "join"
  VehicleId vehicle = kNoVehicle;  // named by the writer's partition, or claimed by the sample
  std::uint64_t writer = 0;        // identity of the writing endpoint
  const char* counter = "";        // what counts it: "rejected_crc"
  const char* field = "";          // as fleet.idl calls it
  std::string why;                 // "cruise_m_s is 7, must be 0 to 2.5"
  // It happens to a sound peer, too, for a moment: while a world or the peer restarts.
  bool passing = false;
};

// "refuses a beacon of vehicle 5: cruise_m_s is 7, must be 0 to 2.5 (rejected_out_of_range)".
std::string Describe(const Refusal& refusal);

}  // namespace giveway
