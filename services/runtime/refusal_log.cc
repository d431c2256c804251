#include "services/runtime/refusal_log.h"

#include <algorithm>

#include "services/runtime/process.h"

namespace giveway {
namespace {

constexpr std::size_t kMostFaults = 256;  // of different writers and fields, remembered
constexpr double kLinesPerSecond = 0.2;
// What passes in a moment is no news before it has happened so often: a second's worth.
constexpr std::uint32_t kNotPassing = 20;

}  // namespace

bool RefusalLog::IsNews(const Refusal& refusal) {
  const std::string key =
      std::to_string(refusal.writer) + refusal.sample + refusal.counter + refusal.field;
  const auto [fault, is_new] = counts_.try_emplace(key, 0);
  const std::uint32_t count = ++fault->second;
  if (is_new) {
    oldest_.push_back(key);
    if (oldest_.size() > kMostFaults) {
      counts_.erase(oldest_.front());
      oldest_.pop_front();
    }
  }
  return count == (refusal.passing ? kNotPassing : 1);
}

std::optional<std::string> RefusalLog::Note(const Refusal& refusal, SteadyTime now) {
  if (!IsNews(refusal)) return std::nullopt;
  return Note(Describe(refusal) + "; said once, counted always", now);
}

std::optional<std::string> RefusalLog::Note(const std::string& line, SteadyTime now) {
  lines_left_ = std::min(kMostAtOnce, lines_left_ + Seconds(now - filled_) * kLinesPerSecond);
  filled_ = now;
  if (lines_left_ < 1) {
    ++left_out_;
    return std::nullopt;
  }
  --lines_left_;
  if (left_out_ == 0) return line;
  const std::string left_out = std::to_string(left_out_);
  left_out_ = 0;
  return line + " (" + left_out + " such lines were left out)";
}

void LogNews(std::span<const Refusal> refusals, const std::vector<std::string>& unfit,
             SteadyTime now, RefusalLog* log) {
  for (const Refusal& refusal : refusals) {
    if (const auto line = log->Note(refusal, now)) LogWarning(*line);
  }
  for (const std::string& text : unfit) {
    if (const auto line = log->Note(text, now)) LogWarning(*line);
  }
}

}  // namespace giveway
