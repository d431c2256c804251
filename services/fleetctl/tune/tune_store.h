// The folder of a search: the evidence of every trial as a file of its own, written as soon as
// the trial is over, so that an interrupted search can be resumed.
//
//   FOLDER/plan.json            what is searched; another search may not continue in this folder
//   FOLDER/profiles/NAME.xml    what was tried
//   FOLDER/trials/NAME-N.json   what it showed; verify-NAME-N.json: in the fresh runs at the end
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "services/fleetctl/tune/tune_evidence.h"
#include "services/runtime/json.h"

namespace giveway::fleetctl {

Json EvidenceJson(const TrialEvidence& evidence);
std::string ToJson(const TrialEvidence& evidence);
// nullopt if the text is not in the format of ToJson.
std::optional<TrialEvidence> EvidenceFrom(const std::string& json);

class TuneStore {
 public:
  // Creates the folder. Throws OutputError if it cannot be written, or has the evidence of another
  // search: `plan` is one line with everything that identifies this one.
  TuneStore(std::filesystem::path folder, const std::string& plan);

  const std::filesystem::path& Folder() const { return folder_; }
  // All evidence from before.
  const std::vector<TrialEvidence>& Found() const { return found_; }
  void Keep(const TrialEvidence& evidence) const;
  // Replaces the file atomically.
  void Write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path folder_;
  std::vector<TrialEvidence> found_;
};

}  // namespace giveway::fleetctl
