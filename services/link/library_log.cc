#include "services/link/library_log.h"

#include <cstdio>
#include <memory>
#include <mutex>
#include <utility>

#include "services/link/fastdds_version.h"

namespace giveway::link {
namespace {

constexpr std::size_t kComplaintBytes = 2000;

using Take = std::function<void(const std::string& line)>;

void WriteToStderr(const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); }

struct Complaints {
  std::mutex mutex;
  std::string text;
  Take take = WriteToStderr;
};

// Never destroyed: the library's log thread may outlive static destruction.
Complaints& TheComplaints() {
  static Complaints& complaints = *new Complaints;
  return complaints;
}

class Consumer final : public dds::LogConsumer {
 public:
  void Consume(const dds::Log::Entry& entry) override {
    const std::string line = "Fast DDS: " + entry.message;
    Complaints& complaints = TheComplaints();
    Take take;
    {
      const std::scoped_lock lock(complaints.mutex);
      take = complaints.take;
      if (complaints.text.size() <= kComplaintBytes) complaints.text += "\n  " + line;
    }
    take(line);
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
  Complaints& complaints = TheComplaints();
  const std::scoped_lock lock(complaints.mutex);
  complaints.take = std::move(take);
}

std::string LibraryComplaints() {
  dds::Log::Flush();
  Complaints& complaints = TheComplaints();
  const std::scoped_lock lock(complaints.mutex);
  return std::exchange(complaints.text, {});
}

}  // namespace giveway::link
