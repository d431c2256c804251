#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/formatter.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "services/runtime/identity.h"
#include "services/runtime/json.h"
#include "services/runtime/log_queue.h"
#include "services/runtime/process.h"
#include "services/types/check.h"

namespace giveway {
namespace {

// Of the line being written: lines are formatted on the thread that logs.
thread_local SteadyTime line_at{0};

// 0 before it is known, and in a process that is no vehicle.
std::atomic<std::uint32_t> log_vehicle{0};

std::string_view View(spdlog::string_view_t text) { return {text.data(), text.size()}; }

class JsonFormatter : public spdlog::formatter {
 public:
  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& line) override {
    const auto time = std::chrono::floor<std::chrono::milliseconds>(message.time);
    const auto second = std::chrono::floor<std::chrono::seconds>(time);
    Json json;
    json["time"] =
        fmt::format("{:%FT%T}.{:03d}Z", fmt::gmtime(std::chrono::system_clock::to_time_t(second)),
                    (time - second).count());
    json["steady_ns"] = line_at.count();
    json["level"] = View(spdlog::level::to_string_view(message.level));
    json["process"] = View(message.logger_name);
    const std::uint32_t id = log_vehicle.load(std::memory_order_relaxed);
    if (id != 0) json["vehicle"] = id;
    json["text"] = View(message.payload);
    fmt::format_to(std::back_inserter(line), "{}\n", JsonText(std::move(json)));
  }
  std::unique_ptr<spdlog::formatter> clone() const override {
    return std::make_unique<JsonFormatter>();
  }
};

constexpr const char* kTextPattern = "%H:%M:%S.%e %-7l %n%*: %v";

// "%*" of the pattern: " 3" after the name of a vehicle whose id came from the world, not a flag.
class GivenId : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&,
              spdlog::memory_buf_t& line) override {
    const std::uint32_t id = log_vehicle.load(std::memory_order_relaxed);
    if (id == 0 || View(message.logger_name) != "vehicle") return;
    fmt::format_to(std::back_inserter(line), " {}", id);
  }
  std::unique_ptr<spdlog::custom_flag_formatter> clone() const override {
    return std::make_unique<GivenId>();
  }
};
constexpr std::size_t kMostWaitingBytes = 256U << 10U;  // some two thousand lines

// Of this process, from InitLog on. Never destroyed: its thread may be held up by a reader that has
// stopped, and the end of the process does not wait for that. spdlog's own asynchronous logger
// would: its pool posts a message that may not be dropped when it is destroyed, and joins; and its
// sink holds the lock of stderr while it writes.
std::atomic<LogQueue*> queue{nullptr};

LogQueue& Queue() {
  if (queue.load() == nullptr) queue = new LogQueue(STDERR_FILENO, kMostWaitingBytes);
  return *queue.load();
}

// Formats on the thread that logs, and leaves the writing to the queue.
class QueueSink : public spdlog::sinks::base_sink<std::mutex> {
 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    Queue().Push(fmt::to_string(line));
  }
  void flush_() override {}
};

std::unique_ptr<spdlog::formatter> MakeFormatter(const std::string& format) {
  if (format == "json") return std::make_unique<JsonFormatter>();
  auto text = std::make_unique<spdlog::pattern_formatter>();
  text->add_flag<GivenId>('*').set_pattern(kTextPattern);
  return text;
}

LogQueue::Notice MakeNotice(const std::string& process_name, const std::string& format) {
  return [process_name, shared = std::shared_ptr<spdlog::formatter>(MakeFormatter(format))](
             std::uint64_t dropped) {
    const std::string text =
        fmt::format("{} log line{} dropped here: the log was not read, or could not be written",
                    dropped, dropped == 1 ? " was" : "s were");
    line_at = SteadyNow();
    spdlog::memory_buf_t line;
    shared->format({process_name, spdlog::level::warn, text}, line);
    return fmt::to_string(line);
  };
}

// Until InitLog: written at once.
std::shared_ptr<spdlog::logger> MakeLogger(const std::string& name) {
  auto logger =
      std::make_shared<spdlog::logger>(name, std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_formatter(MakeFormatter("text"));
  return logger;
}

// Never destroyed: the library's log thread lives until after static destruction.
std::shared_ptr<spdlog::logger>& Logger() {
  static auto& logger = *new std::shared_ptr<spdlog::logger>(MakeLogger("giveway"));
  return logger;
}

void Log(spdlog::level::level_enum level, const std::string& text, SteadyTime at) {
  line_at = at;
  Logger()->log(level, spdlog::string_view_t(text.data(), text.size()));
}

}  // namespace

void InitLog(const std::string& process_name, const std::string& format, const std::string& level) {
  GIVEWAY_CHECK(format == "text" || format == "json", format);
  Queue().SetNotice(MakeNotice(process_name, format));
  auto logger = std::make_shared<spdlog::logger>(process_name, std::make_shared<QueueSink>());
  logger->set_formatter(MakeFormatter(format));
  const auto parsed = spdlog::level::from_str(level);  // off for a name it does not know
  GIVEWAY_CHECK(parsed != spdlog::level::off, level);
  logger->set_level(parsed);
  Logger() = std::move(logger);
}

bool FlushLog(Nanoseconds limit) { return queue.load() == nullptr || Queue().Flush(limit); }

std::uint64_t LogLinesDropped() { return queue.load() == nullptr ? 0 : Queue().Dropped(); }

void SetLogVehicle(VehicleId id) { log_vehicle = Number(id); }

void LogDebug(const std::string& text) { Log(spdlog::level::debug, text, SteadyNow()); }
void LogInfo(const std::string& text) { LogInfo(text, SteadyNow()); }
void LogInfo(const std::string& text, SteadyTime at) { Log(spdlog::level::info, text, at); }
void LogWarning(const std::string& text) { LogWarning(text, SteadyNow()); }
void LogWarning(const std::string& text, SteadyTime at) { Log(spdlog::level::warn, text, at); }
void LogError(const std::string& text) { Log(spdlog::level::err, text, SteadyNow()); }

}  // namespace giveway
