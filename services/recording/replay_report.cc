#include "services/recording/replay_report.h"

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>

#include "report.pb.h"
#include "services/runtime/utf8.h"
#include "services/types/check.h"

namespace giveway {
namespace {

std::uint32_t StepsOf(const std::vector<ReplayedFile>& files) {
  std::uint32_t steps = 0;
  for (const ReplayedFile& file : files) steps += file.steps;
  return steps;
}

std::string_view Reason(Verdict verdict) {
  if (verdict == Verdict::kPassed) return "identical";
  return verdict == Verdict::kFailed ? "different" : "unreadable";
}

void Set(const ReplayedFile& file, schema::ReplayedFile* message) {
  message->set_file(WellFormed(file.file));
  message->set_vehicle(Number(file.vehicle));
  message->set_steps(file.steps);
  message->set_complete(file.complete);
  message->set_lost(file.lost);
  message->set_failure(WellFormed(file.failure));
  message->set_part(file.part);
  message->set_finding(WellFormed(file.finding));
  if (!file.difference) return;
  schema::ReplayDifference& difference = *message->mutable_difference();
  difference.set_step(file.difference->step);
  difference.set_tick(Number(file.difference->tick));
  difference.set_field(file.difference->field.field);
  difference.set_recorded(file.difference->field.recorded);
  difference.set_replayed(file.difference->field.replayed);
}

std::string Line(const ReplayedFile& file) {
  std::string text = file.file + ": ";
  if (file.vehicle != kNoVehicle) {
    text += fmt::format("vehicle {}, {}{} steps the same", Number(file.vehicle),
                        file.part > 1 ? fmt::format("part {}, ", file.part) : "", file.steps);
  }
  if (const auto& found = file.difference) {
    text += fmt::format("; step {} (tick {}) differs: {} was {}, is now {}", found->step,
                        Number(found->tick), found->field.field, found->field.recorded,
                        found->field.replayed);
  } else if (!file.finding.empty()) {
    text += (file.vehicle == kNoVehicle ? "" : "; ") + file.finding;
  } else if (!file.complete) {
    text += "; then cut off: its writer died, or its disk took nothing more";
  } else if (!file.failure.empty()) {
    text += "; then it could not be written: " + file.failure;
  }
  if (file.lost > 0) text += fmt::format("; {} steps were not recorded", file.lost);
  return text + '\n';
}

}  // namespace

Verdict OverallVerdict(const std::vector<ReplayedFile>& files) {
  const auto unreadable = [](const ReplayedFile& file) { return !file.finding.empty(); };
  if (files.empty() || std::ranges::any_of(files, unreadable)) return Verdict::kNotRun;
  const auto differs = [](const ReplayedFile& file) { return file.difference.has_value(); };
  return std::ranges::any_of(files, differs) ? Verdict::kFailed : Verdict::kPassed;
}

std::string ToJson(const std::vector<ReplayedFile>& files) {
  schema::ReplayReport message;
  const Verdict verdict = OverallVerdict(files);
  message.set_verdict(verdict == Verdict::kPassed   ? schema::Report::passed
                      : verdict == Verdict::kFailed ? schema::Report::failed
                                                    : schema::Report::not_run);
  message.set_reason(std::string(Reason(verdict)));
  message.set_steps(StepsOf(files));
  for (const ReplayedFile& file : files) Set(file, message.add_files());
  google::protobuf::util::JsonPrintOptions options;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string json;
  const auto status = google::protobuf::util::MessageToJsonString(message, &json, options);
  GIVEWAY_CHECK(status.ok(), status.ToString());
  return json;
}

std::string ToText(const std::vector<ReplayedFile>& files) {
  std::string text;
  for (const ReplayedFile& file : files) text += Line(file);
  return text + fmt::format("{}: {} steps of {} recording{}\n", Reason(OverallVerdict(files)),
                            StepsOf(files), files.size(), files.size() == 1 ? "" : "s");
}

}  // namespace giveway
