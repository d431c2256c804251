#include "services/link/library_release.h"

#include "services/link/fastdds_version.h"

namespace giveway::link {

std::string_view LibraryName() { return kLibraryName; }
int LibraryMajor() { return kLibraryMajor; }

}  // namespace giveway::link
