#include "services/link/fastdds/library_log.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <mutex>
#include <string_view>
#include <utility>

#include "services/link/fastdds/fastdds_version.h"

namespace giveway::link {
namespace {

using std::chrono::steady_clock;

constexpr std::size_t kComplaintBytes = 2000;
constexpr std::size_t kRemembered = 16;  // different lines that may be repeated in turns
constexpr auto kRepeatAfter = std::chrono::seconds(10);
constexpr std::string_view kWatchLost = "Could not set next deadline in the history";

using Take = std::function<void(const std::string& line)>;

void WriteToStderr(const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); }

// A line that was passed on, and how often it came since.
struct Passed {
  std::string text;
  steady_clock::time_point at;
  std::uint32_t repeated = 0;
};

struct LibraryLog {
  std::mutex mutex;
  std::string complaints;
  Take take = WriteToStderr;
  std::array<Passed, kRemembered> passed;
  std::atomic<std::uint32_t> watches_lost{0};
};

// Never destroyed: the library's log thread may outlive static destruction.
LibraryLog& TheLog() {
  static LibraryLog& log = *new LibraryLog;
  return log;
}

// The line with what is known about it appended; empty if the same was passed on a moment ago.
std::string ToPass(LibraryLog& log, const std::string& text, steady_clock::time_point now) {
  auto passed = std::ranges::find(log.passed, text, &Passed::text);
  if (passed != log.passed.end() && now - passed->at < kRepeatAfter) {
    ++passed->repeated;
    return {};
  }
  std::string line = "Fast DDS: " + text;
  if (passed == log.passed.end()) {
    passed = std::ranges::min_element(log.passed, {}, &Passed::at);
  } else if (passed->repeated > 0) {
    line += " (" + std::to_string(passed->repeated) + " times more since)";
  }
  *passed = {text, now, 0};
  if (text.find(kWatchLost) != std::string::npos) {
    line += " (the library no longer watches the deadlines of one reader)";
  }
  return line;
}

class Consumer final : public dds::LogConsumer {
 public:
  void Consume(const dds::Log::Entry& entry) override {
    LibraryLog& log = TheLog();
    if (entry.message.find(kWatchLost) != std::string::npos) ++log.watches_lost;
    std::string line;
    Take take;
    {
      const std::scoped_lock lock(log.mutex);
      if (log.complaints.size() <= kComplaintBytes) {
        log.complaints += "\n  Fast DDS: " + entry.message;
      }
      line = ToPass(log, entry.message, steady_clock::now());
      take = log.take;
    }
    if (!line.empty()) take(line);
  }
};

}  // namespace

void TakeOverLibraryLog() {
  static std::once_flag once;
  std::call_once(once, [] {
    dds::Log::ClearConsumers();
    dds::Log::RegisterConsumer(std::make_unique<Consumer>());
    dds::Log::SetVerbosity(dds::Log::Kind::Error);
  });
}

void SetLibraryLog(Take take) {
  LibraryLog& log = TheLog();
  const std::scoped_lock lock(log.mutex);
  log.take = std::move(take);
}

std::string LibraryComplaints() {
  dds::Log::Flush();
  LibraryLog& log = TheLog();
  const std::scoped_lock lock(log.mutex);
  return std::exchange(log.complaints, {});
}

std::uint32_t DeadlineWatchesLost() { return TheLog().watches_lost.load(); }

}  // namespace giveway::link
