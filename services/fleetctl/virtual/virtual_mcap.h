// Writes a virtual run as the recording that a recorder would have made: what bodies, brains and
// world publish in each tick, with the times of the run.
#pragma once

#include <cstdint>
#include <string>

#include "services/observer/capture/capture_files.h"
#include "sim_world/virtual/virtual_fleet.h"

namespace giveway::fleetctl {

class VirtualRecording {
 public:
  // Creates the file. Throws OutputError.
  explicit VirtualRecording(const std::string& path);

  void Note(const sim::VirtualFleet& fleet);
  // Throws OutputError if the file could not be written.
  void Close();

 private:
  void Write(const char* topic, std::string bytes);
  void NoteVehicle(const sim::VirtualFleet& fleet, std::size_t index);

  CaptureFiles files_;
  std::uint64_t now_ns_ = 0;
  std::uint32_t sequence_ = 0;
};

}  // namespace giveway::fleetctl
