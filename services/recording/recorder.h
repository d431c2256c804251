// Writes the inputs and outputs of a brain into a file, so that its decisions can be made again.
//
// The deciding thread only copies into a bounded queue and never waits; a thread of the recorder's
// own makes bytes of it and writes one record at a time. A full queue (the disk does not keep up
// for six seconds) or a failed write ends the recording, for a brain cannot be led over a gap:
// what is not written from then on is counted and reported, at once, every minute and at the end.
// What was written survives the death of the process at any moment; it does not wait for the disk.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "services/types/handover.h"
#include "services/types/time.h"
#include "services/types/vehicle_io.h"
#include "services/types/vehicle_options.h"

namespace giveway {

struct RecorderOptions {
  std::uint64_t split_bytes = 0;  // starts another file before one grows beyond that; 0: never
  // Keeps only the last two files, of so long each, so that this much at least is there; 0: all.
  Nanoseconds ring{0};
};

struct RecorderTally {
  std::uint32_t steps = 0;  // in the file
  std::uint32_t lost = 0;   // not in it
};

class Recorder {
 public:
  // Makes the file, under another name where it is there already; see recording_writer.h. Throws
  // std::runtime_error if it cannot.
  explicit Recorder(const std::string& file, const RecorderOptions& options = {});
  // As Close.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // The brain is made; first of all, and once.
  void Begin(const VehicleOptions& options, std::uint32_t boot_epoch,
             const std::optional<Handover>& handover = std::nullopt);
  void Reseat(const VehicleOptions& options);
  // After each step. `hash` is of the brain's state after it.
  void Step(const Inputs& inputs, const Outputs& outputs, std::uint64_t hash);

  // Of a ring: true once the file is as long as it gets. Then Image is to follow the step.
  bool WantsImage(SteadyTime now) const;
  // The brain as it is now; a new file starts with it.
  void Image(std::string state, std::uint64_t hash, SteadyTime now);
  // Of a ring: what it holds now, and continues to hold until the file is full, is never removed.
  // False where it keeps kMostKept already, is no ring, or has ended.
  bool Keep();

  // Writes what is still queued, ends the file, and logs how much is in it.
  RecorderTally Close();

 private:
  static constexpr std::uint32_t kMostKept = 8;

  struct Queued;
  class Writer;
  template <typename Fill>
  bool Queue(Fill&& fill);
  void ReportLoss();

  const RecorderOptions options_;
  std::unique_ptr<Writer> writer_;
  VehicleOptions drives_by_;
  SteadyTime image_due_{0};  // 0: no step yet
  std::uint32_t kept_ = 0;
  bool keeps_next_ = false;  // with the next record
  RecorderTally tally_;
  bool ended_ = false;  // something was lost: nothing more is queued
  SteadyTime next_report_{0};
  bool closed_ = false;
};

}  // namespace giveway
