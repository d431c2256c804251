// The folder of a search: the evidence of every trial as a file of its own, written the moment the
// trial is over, so that a search that was cut off continues where it stopped.
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
// Nothing if the text is not what ToJson writes.
std::optional<TrialEvidence> EvidenceFrom(const std::string& json);

class TuneStore {
 public:
  // Makes the folder. Throws OutputError if it cannot be written, or holds the evidence of another
  // search: `plan` is one line that says all that matters of this one.
  TuneStore(std::filesystem::path folder, const std::string& plan);

  const std::filesystem::path& Folder() const { return folder_; }
  // All there is from before.
  const std::vector<TrialEvidence>& Found() const { return found_; }
  void Keep(const TrialEvidence& evidence) const;
  // Replaces the file as a whole, never half of it.
  void Write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path folder_;
  std::vector<TrialEvidence> found_;
};

}  // namespace giveway::fleetctl
