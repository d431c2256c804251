// Which refusals are logged: each writer's fault of a field once, and never so many lines that a
// writer that sends nothing else could fill a disk. The counters keep counting.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/types/refusal.h"
#include "services/types/time.h"

namespace giveway {

class RefusalLog {
 public:
  // The line to log; nothing if it was said, or if too much was said lately.
  std::optional<std::string> Note(const Refusal& refusal, SteadyTime now);
  // The same of what is known to be new, such as an endpoint that does not match.
  std::optional<std::string> Note(const std::string& line, SteadyTime now);

 private:
  bool IsNews(const Refusal& refusal);

  std::map<std::string, std::uint32_t> counts_;  // by writer and fault
  std::deque<std::string> oldest_;               // of counts_
  double lines_left_ = kMostAtOnce;
  SteadyTime filled_{0};
  std::uint32_t left_out_ = 0;  // since the last line

  static constexpr double kMostAtOnce = 20;
};

// Logs what of these is news: refusals, and lines about endpoints that will never match.
void LogNews(std::span<const Refusal> refusals, const std::vector<std::string>& unfit,
             SteadyTime now, RefusalLog* log);

}  // namespace giveway
