// Reads a recording record by record, as far as it is whole, and says in words why it ends there.
// Believes nothing: whatever the bytes are, what comes out can be given to a brain.
#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <string>

#include "services/recording/recording.h"

namespace giveway {

class RecordingFile {
 public:
  // Reads the mark and how the file starts. `stream` must outlive this.
  explicit RecordingFile(std::istream* stream);

  // The making of the vehicle, or nothing. If neither this nor Continues(), nothing can be
  // replayed: Complaint() says why.
  const std::optional<RecordedLife>& Life() const { return life_; }
  // Which part it is, where it is a part and not the first.
  const std::optional<RecordedContinuation>& Continues() const { return continues_; }
  // The next step, reseat or image (the first record of a part, if at all); nothing at the end of
  // what is whole.
  std::optional<Record> Next();

  // Why nothing more can be read; empty where the file ends as it should or was cut off.
  const std::string& Complaint() const { return complaint_; }
  // True if the file stops without saying so: its writer died.
  bool WasCutOff() const { return cut_off_; }
  // The recording's own last word; nothing if it was not reached.
  const std::optional<RecordedEnd>& End() const { return end_; }

 private:
  bool ReadMark();
  std::optional<Record> ReadRecord();
  std::optional<Record> Refuse(const std::string& why);
  std::string WhyNoOptions(const VehicleOptions& options) const;
  void Begin(Record first);

  std::istream& stream_;
  std::optional<RecordedLife> life_;
  std::optional<RecordedContinuation> continues_;
  std::optional<RecordedEnd> end_;
  std::string complaint_;
  bool cut_off_ = false;
  std::uint32_t records_ = 0;
  std::string payload_;
};

}  // namespace giveway
