#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <memory>

#include "services/app/json_line.h"
#include "services/app/process.h"
#include "services/types/check.h"

namespace giveway::app {
namespace {

// Of the line being written: lines are formatted on the thread that logs.
thread_local SteadyTime line_at{0};

std::string_view View(spdlog::string_view_t text) { return {text.data(), text.size()}; }

class JsonFormatter : public spdlog::formatter {
 public:
  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& line) override {
    const auto time = std::chrono::floor<std::chrono::milliseconds>(message.time);
    const auto second = std::chrono::floor<std::chrono::seconds>(time);
    fmt::format_to(std::back_inserter(line),
                   "{{\"time\":\"{:%FT%T}.{:03d}Z\",\"steady_ns\":{},\"level\":{},\"process\":{},"
                   "\"text\":{}}}\n",
                   fmt::gmtime(std::chrono::system_clock::to_time_t(second)),
                   (time - second).count(), line_at.count(),
                   JsonString(View(spdlog::level::to_string_view(message.level))),
                   JsonString(View(message.logger_name)), JsonString(View(message.payload)));
  }
  std::unique_ptr<spdlog::formatter> clone() const override {
    return std::make_unique<JsonFormatter>();
  }
};

std::shared_ptr<spdlog::logger> MakeLogger(const std::string& name) {
  auto logger =
      std::make_shared<spdlog::logger>(name, std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern("%H:%M:%S.%e %-7l %n: %v");
  return logger;
}

std::shared_ptr<spdlog::logger>& Logger() {
  static std::shared_ptr<spdlog::logger> logger = MakeLogger("giveway");
  return logger;
}

void Log(spdlog::level::level_enum level, const std::string& text, SteadyTime at) {
  line_at = at;
  Logger()->log(level, spdlog::string_view_t(text.data(), text.size()));
}

}  // namespace

void InitLog(const std::string& process_name, const std::string& format, const std::string& level) {
  GIVEWAY_CHECK(format == "text" || format == "json", format);
  auto logger = MakeLogger(process_name);
  if (format == "json") logger->set_formatter(std::make_unique<JsonFormatter>());
  const auto parsed = spdlog::level::from_str(level);  // off for a name it does not know
  GIVEWAY_CHECK(parsed != spdlog::level::off, level);
  logger->set_level(parsed);
  Logger() = std::move(logger);
}

void LogDebug(const std::string& text) { Log(spdlog::level::debug, text, SteadyNow()); }
void LogInfo(const std::string& text) { LogInfo(text, SteadyNow()); }
void LogInfo(const std::string& text, SteadyTime at) { Log(spdlog::level::info, text, at); }
void LogWarning(const std::string& text) { LogWarning(text, SteadyNow()); }
void LogWarning(const std::string& text, SteadyTime at) { Log(spdlog::level::warn, text, at); }
void LogError(const std::string& text) { Log(spdlog::level::err, text, SteadyNow()); }

}  // namespace giveway::app
