// The files of one recording: each made under a name that was free, so that none is ever written
// over; split by size where that is asked for; and ended so that a reader knows why it ends, on a
// full disk too. Knows no thread. The format is documented in idl/recording.proto.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

#include "services/recording/recording.h"

namespace giveway {

// One file, as far as it is whole. Closes it on destruction.
class RecordingPart {
 public:
  RecordingPart(std::string name, int descriptor, bool is_regular);
  RecordingPart(RecordingPart&& other) noexcept;
  RecordingPart& operator=(RecordingPart&& other) noexcept;
  ~RecordingPart();

  // 0, or the errno. What is appended as a step may be given up for the end.
  int Append(std::string_view bytes, bool is_step);
  // Ends the file behind the last whole frame. If the disk has no space for that, the last steps
  // are removed to make some, and added to `lost`. False if even that failed.
  bool PutEnd(RecordedEnd end);

  const std::string& Name() const { return name_; }
  bool IsRegular() const { return is_regular_; }
  std::uint64_t Bytes() const { return bytes_; }
  std::uint32_t Steps() const { return steps_; }

 private:
  bool WriteAt(std::uint64_t offset, std::string_view bytes) const;

  std::string name_;
  int descriptor_;
  bool is_regular_;
  std::uint64_t bytes_ = 0;  // of whole frames
  std::uint32_t steps_ = 0;
  std::deque<std::uint64_t> last_steps_;  // where they start
};

class RecordingWriter {
 public:
  // `path`, or where that is there already PATH with the first free number before its extension. A
  // device or a pipe is written to as it is. `split_bytes`: starts another file before one grows
  // beyond that; 0: never. `is_ring`: starts another with every image, and removes all but the last
  // two. Throws std::runtime_error if the first cannot be made.
  RecordingWriter(const std::string& path, std::uint64_t split_bytes, bool is_ring = false);

  // True if it is in a file. After a failure nothing is: a brain cannot be led over a gap.
  bool Write(const Record& record);
  // Of a ring: the files there are now are not removed any more.
  void Keep();
  // Ends the last file. `lost` steps were not given to Write; `why`, where that is not the fault of
  // the file.
  void End(std::uint32_t lost, const std::string& why);

  // "FILE: No space left on device"; empty: all is well.
  std::string Failure() const { return failure_.empty() ? "" : failed_file_ + ": " + failure_; }
  // In all files.
  std::uint32_t Steps() const { return steps_before_ + part_.Steps(); }
  const std::string& FirstName() const { return first_name_; }
  std::uint32_t Parts() const { return head_.part; }

 private:
  RecordingPart MakeNext();
  bool Split();
  void MakeRoom(const std::string& before);
  bool Fail(const std::string& file, const std::string& why, std::uint32_t lost);

  const std::string path_;
  const std::uint64_t split_bytes_;
  const bool is_ring_;
  std::uint32_t number_ = 1;  // of the last name tried
  RecordingPart part_;
  const std::string first_name_;
  RecordedContinuation head_;  // of the part being written
  std::uint32_t steps_before_ = 0;
  std::deque<std::string> removable_;  // of a ring: those before the part being written
  bool keeps_part_ = false;            // which is not to be removed either
  std::string failed_file_;
  std::string failure_;  // why nothing more is written; empty: all is well
};

}  // namespace giveway
