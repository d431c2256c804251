#include "services/link/library_log.h"

#include <cstdio>
#include <memory>
#include <mutex>
#include <utility>

#include "services/link/fastdds_version.h"

namespace giveway::link {
namespace {

constexpr std::size_t kComplaintBytes = 2000;

struct Complaints {
  std::mutex mutex;
  std::string text;
};

// Never destroyed: the library's log thread may outlive static destruction.
Complaints& TheComplaints() {
  static Complaints& complaints = *new Complaints;
  return complaints;
}

class StderrConsumer final : public dds::LogConsumer {
 public:
  void Consume(const dds::Log::Entry& entry) override {
    std::fprintf(stderr, "Fast DDS: %s\n", entry.message.c_str());
    Complaints& complaints = TheComplaints();
    const std::scoped_lock lock(complaints.mutex);
    if (complaints.text.size() > kComplaintBytes) return;
    complaints.text += "\n  Fast DDS: " + entry.message;
  }
};

}  // namespace

void TakeOverLibraryLog() {
  static std::once_flag once;
  std::call_once(once, [] {
    dds::Log::ClearConsumers();
    dds::Log::RegisterConsumer(std::make_unique<StderrConsumer>());
    dds::Log::SetVerbosity(dds::Log::Kind::Error);
  });
}

std::string LibraryComplaints() {
  dds::Log::Flush();
  Complaints& complaints = TheComplaints();
  const std::scoped_lock lock(complaints.mutex);
  return std::exchange(complaints.text, {});
}

}  // namespace giveway::link
