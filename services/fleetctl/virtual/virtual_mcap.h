// Writes a virtual run as the recording that a recorder would have made: what bodies, brains and
// world publish in each tick, with the times of the run.
#pragma once

#include <cstdint>
#include <string>

#include "services/observer/capture/capture_files.h"
#include "sim_world/virtual/virtual_fleet.h"

namespace giveway::fleetctl {

// Throws OutputError unless a recording can be made there; an existing file is another one. Leaves
// no file behind.
void CheckRecordable(const std::string& path);

// Unless Close succeeds, no file is left: the same command can be given again.
class VirtualRecording {
 public:
  // Creates the file. Throws OutputError.
  explicit VirtualRecording(const std::string& path);
  ~VirtualRecording();
  VirtualRecording(const VirtualRecording&) = delete;
  VirtualRecording& operator=(const VirtualRecording&) = delete;

  void Note(const sim::VirtualFleet& fleet);
  // Throws OutputError if the file could not be written.
  void Close();

 private:
  void Write(const char* topic, std::string bytes);
  void NoteVehicle(const sim::VirtualFleet& fleet, std::size_t index);

  CaptureFiles files_;
  bool whole_ = false;
  std::uint64_t now_ns_ = 0;
  std::uint32_t sequence_ = 0;
};

}  // namespace giveway::fleetctl
