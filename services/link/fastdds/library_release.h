// Which Fast DDS this program was built against.
#pragma once

#include <string_view>

namespace giveway::link {

// "Fast DDS 2.9.1".
std::string_view LibraryName();

// The first number of its release: 2 or 3.
int LibraryMajor();

}  // namespace giveway::link
