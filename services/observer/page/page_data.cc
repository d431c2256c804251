#include "services/observer/page/page_text.h"

namespace giveway {

std::string PageWithRun(std::string_view run_json) {
  constexpr std::string_view kPlace = "<script type=\"application/json\" id=\"run\">";
  std::string page = PageText();
  const std::size_t place = page.find(kPlace);
  if (place == std::string::npos) return page;
  // Text within the data must not end the element.
  std::string data;
  data.reserve(run_json.size());
  for (const char c : run_json) {
    if (c == '<') {
      data += "\\u003c";
    } else {
      data += c;
    }
  }
  return page.insert(place + kPlace.size(), data);
}

}  // namespace giveway
