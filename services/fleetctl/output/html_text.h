// Text for HTML pages.
#pragma once

#include <string>
#include <string_view>

namespace giveway::fleetctl {

// Escapes HTML special characters, for elements and for attributes in either quotes.
std::string HtmlEscaped(std::string_view text);

}  // namespace giveway::fleetctl
