#include "services/link/fastdds/profile_spelling.h"

#include <regex>

#include "services/link/fastdds/fastdds_version.h"

namespace giveway::link {
namespace {

// Both tags of an element. A name is no part of a longer one.
std::regex TagsOf(std::string_view element) {
  return std::regex("(</?)" + std::string(element) + "(?=[\\s/>])");
}

// 2.9 lists servers by prefix with their locators inside; later releases list the locators alone.
// Only tags are cut, so that every line stays where it is.
std::string WithServersAsLocators(const std::string& profiles) {
  static constexpr std::string_view kEnd = "</RemoteServer>";
  static const std::regex around("</?(RemoteServer|metatrafficUnicastLocatorList)(\\s[^>]*)?>");
  std::string plain;
  std::size_t done = 0;
  for (;;) {
    const std::size_t begin = profiles.find("<RemoteServer", done);
    const std::size_t end = profiles.find(kEnd, begin);
    if (begin == std::string::npos || end == std::string::npos) break;
    plain += profiles.substr(done, begin - done);
    done = end + kEnd.size();
    plain += std::regex_replace(profiles.substr(begin, done - begin), around, "");
  }
  return plain + profiles.substr(done);
}

}  // namespace

std::string InOwnSpelling(std::string profiles) {
  for (const Respelt& element : kRespelt) {
    profiles =
        std::regex_replace(profiles, TagsOf(element.in_2_9), "$1" + std::string(element.here));
  }
  return kServersByPrefix ? profiles : WithServersAsLocators(profiles);
}

}  // namespace giveway::link
