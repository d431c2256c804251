// Records all samples of a run in fleetctl: every topic as received, into one MCAP file. The run
// does not depend on it: a full disk ends the recording and is reported.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "services/link/raw_link.h"
#include "services/observer/capture/capture_files.h"
#include "services/types/time.h"

namespace giveway::fleetctl {

class TopicRecorder {
 public:
  // Creates the file, and joins the domain. Throws OutputError, LinkError.
  TopicRecorder(const link::LinkOptions& options, const std::string& file);

  // Takes the samples that have arrived; writes them to the disk once a second.
  void Turn(SteadyTime now);
  // Ends the file, with these files embedded. Returns false and reports on stderr if something
  // could not be written.
  bool Finish(const std::vector<std::string>& attachments);

 private:
  link::RawLink link_;
  CaptureFiles files_;
  SteadyTime flush_at_{0};
};

// The brains' recordings that were written in this folder since then, by name.
std::vector<std::string> BrainRecordings(const std::string& folder,
                                         std::filesystem::file_time_type since);

}  // namespace giveway::fleetctl
