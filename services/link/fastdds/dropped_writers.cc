#include "services/link/fastdds/dropped_writers.h"

#include "services/link/fastdds/fastdds_version.h"

#if __has_include(<fastrtps/config.h>) && FASTRTPS_VERSION_MAJOR == 2 && FASTRTPS_VERSION_MINOR == 9
#include <dlfcn.h>
#include <fastdds/rtps/reader/RTPSReader.h>

namespace eprosima::fastrtps::rtps {

// Stands in front of the library's own of this name, which says: not where its lease ended. The
// library calls it through tables that the loader fills by name, the program's names first. Of
// readers that keep their records in a file it has others.
[[gnu::used, gnu::externally_visible, gnu::visibility("default")]] bool
RTPSReader::may_remove_history_record(bool /*removed_by_lease*/) {
  return true;
}

}  // namespace eprosima::fastrtps::rtps

namespace giveway::link {
namespace {

const void* ImageOf(const void* address) {
  Dl_info found{};
  return dladdr(address, &found) != 0 ? found.dli_fbase : nullptr;
}

}  // namespace

bool ForgetsDroppedWriters() {
  constexpr char kName[] = "_ZN8eprosima8fastrtps4rtps10RTPSReader25may_remove_history_recordEb";
  const void* const called = dlsym(RTLD_DEFAULT, kName);
  return called != nullptr &&
         ImageOf(called) == ImageOf(reinterpret_cast<const void*>(&ForgetsDroppedWriters));
}

}  // namespace giveway::link

#else

namespace giveway::link {
bool ForgetsDroppedWriters() { return false; }
}  // namespace giveway::link

#endif
