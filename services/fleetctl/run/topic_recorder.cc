#include "services/fleetctl/run/topic_recorder.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <utility>

#include "services/fleetctl/output/output_file.h"

namespace giveway::fleetctl {
namespace {

std::vector<std::size_t> AllTopics() {
  std::vector<std::size_t> topics(link::RawTopics().size());
  std::iota(topics.begin(), topics.end(), std::size_t{0});
  return topics;
}

}  // namespace

TopicRecorder::TopicRecorder(const link::LinkOptions& options, const std::string& file)
    : link_(options, AllTopics()),
      files_({.path = file}, [this](std::size_t topic) { return link_.QosText(topic); }) {
  if (!files_.Start(SteadyTime{0})) throw OutputError(files_.Fault());
}

void TopicRecorder::Turn(SteadyTime now) {
  const bool was_well = files_.Fault().empty();
  link_.Take([&](const link::RawSample& sample) { files_.Write(sample, now); });
  if (now >= flush_at_) {
    files_.Flush();
    flush_at_ = now + kFlushPeriod;
  }
  if (was_well && !files_.Fault().empty()) std::fprintf(stderr, "%s\n", files_.Fault().c_str());
}

bool TopicRecorder::Finish(const std::vector<std::string>& attachments) {
  const bool was_well = files_.Fault().empty();
  files_.AttachAtEnd(attachments);
  const bool whole = was_well && files_.Close();
  if (!files_.Missing().empty()) {
    std::fprintf(stderr, "cannot be read, and is not attached: %s\n", files_.Missing().c_str());
  }
  if (was_well && !whole) std::fprintf(stderr, "%s\n", files_.Fault().c_str());
  return whole;
}

std::vector<std::string> BrainRecordings(const std::string& folder,
                                         std::filesystem::file_time_type since) {
  std::vector<std::string> files;
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end;
       at.increment(error)) {
    if (at->path().filename().string().find(".recording") == std::string::npos) continue;
    std::error_code unknown;
    if (at->last_write_time(unknown) >= since && !unknown) files.push_back(at->path().string());
  }
  std::ranges::sort(files);
  return files;
}

}  // namespace giveway::fleetctl
