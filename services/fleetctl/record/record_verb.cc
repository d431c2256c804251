#include <fmt/format.h>

#include <memory>

#include "services/config/byte_size.h"
#include "services/config/flag_values.h"
#include "services/fleetctl/args/duration_flag.h"
#include "services/fleetctl/args/flag_checks.h"
#include "services/fleetctl/args/observer_flags.h"
#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/record/record.h"
#include "services/fleetctl/survey/local_fleets.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kRecordFooter = R"(
Writes every sample as its writer serialized it, with its source and reception time: nothing is decoded
again. The schema is fleet.idl (omgidl), so that Foxglove, and whatever reads MCAP, shows it.
It is flushed once a second: a recorder that is killed loses that much at most, and the file opens. A
full disk ends the recording, never the fleet.

Examples
  fleetctl record run.mcap --domain 7
  fleetctl record run.mcap --domain 7 --split 256MiB --keep 10GiB
  fleetctl record crash.mcap --domain 7 --last 60s
  fleetctl record run.mcap --domain 7 --ros2      # then: ros2 bag play run.mcap
  fleetctl replay run.mcap

Exit code: 0 recorded, or ended by Ctrl-C; 1 nothing heard, or a file not written; 2 could not run.
)";

std::uint64_t SizeOf(const std::string& flag, const std::string& text) {
  const auto bytes = ParseByteSize(text);
  if (bytes && *bytes >= kLeastSplitBytes && *bytes <= kMostSplitBytes) return *bytes;
  throw CLI::ValidationError(flag, "\"" + text + "\": " + kSplitRemedy);
}

// A bare number is refused: --keep takes it as bytes, --last as seconds.
void SetSplit(const std::string& text, CaptureOptions* files) {
  if (!text.empty() && text.find_first_not_of("0123456789.") == std::string::npos) {
    throw CLI::ValidationError(
        "--split",
        "\"" + text + "\" has no unit; write a size, such as 256MiB, or a time, such as 600s");
  }
  if (const auto seconds = ParseDuration_s(text); seconds && *seconds >= 1) {
    files->split_time = Nanoseconds(static_cast<std::int64_t>(*seconds * 1e9));
    return;
  }
  files->split_bytes = SizeOf("--split", text);
}

std::string TopicNames() {
  std::string names;
  for (const link::RawTopic& topic : link::RawTopics()) {
    names += (names.empty() ? "" : ", ") + std::string(topic.name);
  }
  return names;
}

std::string CheckTopic(const std::string& name) {
  if (RawTopicNamed(name) < link::RawTopics().size()) return {};
  return "there is no topic \"" + name + "\"; there are " + TopicNames();
}

}  // namespace

void AddRecordVerb(CLI::App* fleetctl, int* exit_code) {
  const auto options = std::make_shared<RecordOptions>();
  CLI::App* verb = fleetctl->add_subcommand("record", "Record what travels into an MCAP file");
  verb->footer(kRecordFooter);
  verb->add_option("OUT", options->files.path,
                   "The file, OUT.mcap; it must not be there yet. Of parts, the numbers continue")
      ->required()
      ->check(CheckRecordingName);
  AddObserverFlags(verb, &options->where);
  verb->add_option("--topics", options->topics, "Only these, with commas between them")
      ->delimiter(',')
      ->check(CheckTopic);
  verb->add_flag("--ros2", options->ros2,
                 "Write the fleet as ROS 2 messages, too, so that `ros2 bag play` takes the file");
  verb->add_option("--ros2-rate", options->ros2_rate_hz,
                   "ROS 2 messages a second of each topic; default 10")
      ->check(Between(0.1, 100));
  verb->add_option_function<std::string>(
      "--split", [options](const std::string& text) { SetSplit(text, &options->files); },
      "Another file at this size or after this time: 256MiB, 10m");
  verb->add_option_function<std::string>(
      "--keep",
      [options](const std::string& text) { options->files.keep_bytes = SizeOf("--keep", text); },
      "Remove the oldest parts so that all take no more than this: 10GiB");
  verb->add_option("--attach", options->files.attachments,
                   "Put these files into the recording at its end, such as those of run --record");
  AddDurationFlag(verb, "--last", &options->last_s,
                  "Keep only the last so much in memory, and write it at the end: 60s");
  verb->add_option_function<std::string>(
      "--duration",
      [options](const std::string& text) {
        options->duration_s = ParseDuration_s(text);
        if (!options->duration_s) {
          throw CLI::ValidationError("--duration", "\"" + text + "\" is no duration such as 30s");
        }
      },
      "End after this time; default: at Ctrl-C");
  verb->callback([options, exit_code] {
    constexpr std::uint64_t kUsualSplit = 256ULL << 20U;
    CaptureOptions& files = options->files;
    if (options->ros2) files.profile = "ros2";
    if (files.keep_bytes != 0 && files.split_bytes == 0 && files.split_time.count() == 0) {
      files.split_bytes = kUsualSplit;
    }
    FindFleetIfNotNamed(&options->where);
    *exit_code = RunRecord(*options);
  });
}

}  // namespace giveway::fleetctl
