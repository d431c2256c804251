#include <algorithm>

#include "services/observer/page/page_text.h"

namespace giveway {

std::string PageWithRun(std::string_view run_json) {
  constexpr std::string_view kPlace = "<script type=\"application/json\" id=\"run\">";
  const std::string page = PageText();
  const std::size_t found = page.find(kPlace);
  if (found == std::string::npos) return page;
  const std::size_t place = found + kPlace.size();
  constexpr std::string_view kEscaped = "\\u003c";  // text within the data must not end the element
  const auto escapes = static_cast<std::size_t>(std::ranges::count(run_json, '<'));
  std::string with_run;
  with_run.reserve(page.size() + run_json.size() + escapes * kEscaped.size());
  with_run.append(page, 0, place);
  while (true) {
    const std::size_t end = run_json.find('<');
    with_run += run_json.substr(0, end);
    if (end == std::string_view::npos) break;
    with_run += kEscaped;
    run_json.remove_prefix(end + 1);
  }
  return with_run.append(page, place);
}

}  // namespace giveway
