#include "services/fleetctl/output/library_lines.h"

#include <unistd.h>

#include <deque>
#include <mutex>

#include "services/link/fastdds/library_log.h"

namespace giveway::fleetctl {
namespace {

constexpr std::size_t kMostLines = 32;

struct Lines {
  std::mutex mutex;
  std::deque<std::string> kept;
};

// Never destroyed: the library's log thread may outlive static destruction.
Lines& TheLines() {
  static Lines& lines = *new Lines;
  return lines;
}

}  // namespace

void KeepLibraryLines() {
  if (::isatty(STDOUT_FILENO) != 1) return;
  link::SetLibraryLog([](const std::string& line) {
    Lines& lines = TheLines();
    const std::scoped_lock lock(lines.mutex);
    if (lines.kept.size() == kMostLines) lines.kept.pop_front();
    lines.kept.push_back(line);
  });
}

std::vector<std::string> TakeLibraryLines() {
  Lines& lines = TheLines();
  const std::scoped_lock lock(lines.mutex);
  std::vector<std::string> taken(lines.kept.begin(), lines.kept.end());
  lines.kept.clear();
  return taken;
}

}  // namespace giveway::fleetctl
