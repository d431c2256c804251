#include "services/fleetctl/run/run_ends.h"

namespace giveway::fleetctl {

bool MayEndEarly(const MemberEnd& end, bool open, bool any_vehicle) {
  return end.planned || (open && any_vehicle && end.member != kTheWorld);
}

bool IsGoodEnd(const MemberEnd& end, bool open) {
  const bool is_world = end.member == kTheWorld;
  if (end.planned || (open && !is_world)) return true;
  return !end.how.by_signal && (is_world || end.how.number == 0);
}

// As runtime/log.cc writes them: "12:00:00.000 error   vehicle 2: ...", or an object.
bool IsErrorLine(std::string_view line) {
  constexpr std::size_t kTimeChars = 12;
  if (line.starts_with('{')) return line.find("\"level\":\"error\"") != std::string_view::npos;
  return line.size() > kTimeChars && line.substr(kTimeChars).starts_with(" error ");
}

}  // namespace giveway::fleetctl
