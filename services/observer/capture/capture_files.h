// The files of a recording: one, or parts by size or time of which the oldest go where there are
// too many. One file without a split ends where its index has grown large, and another follows. A
// disk that is full ends the recording; what was flushed before can be read.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "services/observer/capture/fleet_capture.h"
#include "services/types/time.h"

namespace giveway {

// How often a recorder flushes, so that one that is killed loses a second at most: a turn and the
// last sample's age come on top.
inline constexpr Nanoseconds kFlushPeriod = std::chrono::milliseconds(900);

struct CaptureOptions {
  std::string path;                      // OUT.mcap; of parts OUT-0001.mcap, or the next number
  std::uint64_t split_bytes = 0;         // 0: never
  Nanoseconds split_time{0};             // 0: never
  std::vector<std::string> attachments;  // files put into the last part at its end
  std::uint64_t keep_bytes = 0;          // of all parts, also earlier ones; 0: all are kept
  std::string profile;                   // of MCAP; "ros2": `ros2 bag` is to take the files
  std::size_t most_chunks = 100'000;     // of a part: the index of each is in memory; a day's
};

class CaptureFiles {
 public:
  CaptureFiles(CaptureOptions options, FleetCapture::QosOf qos);
  ~CaptureFiles();
  CaptureFiles(const CaptureFiles&) = delete;
  CaptureFiles& operator=(const CaptureFiles&) = delete;

  // All four are false once something could not be written; Fault() says what and why.
  //
  // Makes the first file now rather than with the first sample: a path that cannot be written is
  // found out before anything is worth recording.
  bool Start(SteadyTime now);
  bool Write(const link::RawSample& sample, SteadyTime now);
  bool Write(const Ros2Sample& sample, SteadyTime now);
  bool Flush();
  // These, too; see CaptureOptions.
  void AttachAtEnd(const std::vector<std::string>& files);
  bool Close();
  // Ends the recording without a last part and removes what there is of it: for one that is of no
  // use in part. Nothing of another recording is touched.
  void Discard();

  const std::string& Fault() const { return fault_; }
  // Files that were to be attached and could not be read; empty: none.
  const std::string& Missing() const { return missing_; }
  std::uint64_t Messages() const { return messages_; }
  std::uint64_t Bytes() const { return bytes_; }
  // Those of this recording.
  std::uint32_t Parts() const { return part_ - earlier_parts_; }

 private:
  bool HasParts() const { return options_.split_bytes != 0 || options_.split_time.count() != 0; }
  bool IsPartFull(SteadyTime now) const;
  template <typename Sample>
  bool WriteNewest(const Sample& sample, std::uint64_t log_ns, SteadyTime now);
  bool FindEarlierParts();
  bool Open(SteadyTime now);
  bool ClosePart();
  void Attach(const std::string& path);
  void RemoveOldest();
  bool Append(std::string_view bytes);
  bool Fail(const std::string& what);

  CaptureOptions options_;
  const FleetCapture::QosOf qos_;
  int file_ = -1;
  std::string part_path_;
  std::unique_ptr<FleetCapture> capture_;
  SteadyTime opened_{0};
  std::uint32_t part_ = 0;           // the number in the name of the newest
  std::uint32_t earlier_parts_ = 0;  // the highest number that was there
  std::deque<std::pair<std::string, std::uint64_t>> closed_;  // paths and sizes
  std::uint64_t messages_ = 0;
  std::uint64_t bytes_ = 0;
  std::uint64_t newest_ns_ = 0;  // reception of the newest sample
  std::string fault_;
  std::string missing_;
};

}  // namespace giveway
