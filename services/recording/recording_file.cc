#include "services/recording/recording_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "services/recording/framed_stream.h"

namespace giveway {
namespace {

constexpr std::string_view kAnyMark = "giveway-recording-";
constexpr std::size_t kMostMarkDigits = 9;

}  // namespace

RecordingFile::RecordingFile(std::istream* stream) : stream_(*stream) {
  if (!ReadMark()) return;
  std::optional<Record> first = ReadRecord();
  if (!first) {
    if (complaint_.empty()) complaint_ = "ends before the vehicle was made: it holds no step";
    return;
  }
  Begin(std::move(*first));
}

void RecordingFile::Begin(Record first) {
  if (const auto* head = std::get_if<RecordedContinuation>(&first)) {
    const bool is_one = head->part > 1 && head->boot_epoch != 0 && head->vehicle != kNoVehicle;
    if (is_one) continues_ = *head;
    if (!is_one) complaint_ = "does not say which part of a recording it is";
    return;
  }
  auto* life = std::get_if<RecordedLife>(&first);
  if (life == nullptr) {
    complaint_ = "does not start with the making of a vehicle";
    return;
  }
  if (life->boot_epoch == 0) {
    complaint_ = "the vehicle has no boot epoch";
    return;
  }
  if (life->handover && !IsSound(*life->handover)) {
    complaint_ = "the vehicle takes over what no vehicle hands over";
    return;
  }
  complaint_ = WhyUnusable(life->options);
  if (complaint_.empty()) life_ = std::move(*life);
}

bool RecordingFile::ReadMark() {
  std::string line;
  for (char c = 0; line.size() < kAnyMark.size() + kMostMarkDigits && stream_.get(c);) {
    line += c;
    if (c == '\n') break;
  }
  if (line == kRecordingMark) return true;
  const std::string_view version =
      std::string_view(line).substr(std::min(line.size(), kAnyMark.size()));
  const bool of_other_version =
      line.starts_with(kAnyMark) && version.size() > 1 && version.back() == '\n' &&
      std::all_of(version.begin(), version.end() - 1, [](char c) { return c >= '0' && c <= '9'; });
  if (line.empty()) {
    complaint_ = "is empty: its disk was full, or its writer died at once";
  } else if (of_other_version) {
    complaint_ = fmt::format("is a recording of format {}; this program reads format {}",
                             version.substr(0, version.size() - 1),
                             kRecordingMark.substr(kAnyMark.size(), 1));
  } else if (kRecordingMark.starts_with(line)) {
    complaint_ = "is cut off in its first line";
  } else {
    complaint_ = "is no recording: it does not start with giveway-recording-";
  }
  return false;
}

std::optional<Record> RecordingFile::Refuse(const std::string& why) {
  complaint_ = fmt::format("record {}: {}; nothing after it was read", records_ + 1, why);
  return std::nullopt;
}

std::optional<Record> RecordingFile::ReadRecord() {
  switch (ReadFrame(stream_, &payload_)) {
    case FrameEnd::kEnd:
    case FrameEnd::kCutOff:
      cut_off_ = true;
      return std::nullopt;
    case FrameEnd::kDamaged:
      return Refuse("is damaged: its check sum is wrong");
    case FrameEnd::kFrame:
      break;
  }
  std::optional<Record> record = RecordFrom(payload_);
  if (!record) return Refuse("is whole, but holds what no vehicle writes");
  ++records_;
  return record;
}

std::optional<Record> RecordingFile::Next() {
  if (!(life_ || continues_) || !complaint_.empty() || cut_off_ || end_) return std::nullopt;
  std::optional<Record> record = ReadRecord();
  if (!record) return std::nullopt;
  if (const auto* end = std::get_if<RecordedEnd>(&*record)) {
    end_ = *end;
    if (stream_.peek() != std::istream::traits_type::eof()) {
      complaint_ = "continues behind its end";
    }
    return std::nullopt;
  }
  if (std::holds_alternative<RecordedLife>(*record)) return Refuse("a second vehicle is made");
  if (std::holds_alternative<RecordedContinuation>(*record)) return Refuse("another part starts");
  if (const auto* image = std::get_if<RecordedImage>(&*record)) {
    constexpr std::uint32_t kBehindContinuation = 2;
    if (!continues_ || records_ != kBehindContinuation) return Refuse("a brain amid a part");
    const std::string why = WhyNoOptions(image->options);
    if (!why.empty()) return Refuse(why);
  }
  if (const auto* reseat = std::get_if<RecordedReseat>(&*record)) {
    const std::string why = WhyNoOptions(reseat->options);
    if (!why.empty()) return Refuse(why);
  }
  return record;
}

// Empty if the vehicle could drive by them.
std::string RecordingFile::WhyNoOptions(const VehicleOptions& options) const {
  return options.id == (life_ ? life_->options.id : continues_->vehicle)
             ? WhyUnusable(options)
             : "options are another vehicle's";
}

}  // namespace giveway
