#include "services/link/fastdds/library_release.h"

#include "services/link/fastdds/fastdds_version.h"

namespace giveway::link {

std::string_view LibraryName() { return kLibraryName; }
int LibraryMajor() { return kLibraryMajor; }

}  // namespace giveway::link
