#include "services/fleetctl/run/run_ends.h"

#include <csignal>

namespace giveway::fleetctl {

bool MayEndEarly(const MemberEnd& end, bool open, bool any_vehicle) {
  return end.planned || (open && any_vehicle && end.member != kTheWorld);
}

bool IsGoodEnd(const MemberEnd& end, bool open) {
  const bool is_world = end.member == kTheWorld;
  if (end.planned || (open && !is_world)) return true;
  return !end.how.by_signal && (is_world || end.how.number == 0);
}

bool HasLeft(const MemberEnd& end) {
  if (end.planned) return true;
  if (end.how.by_signal) {
    return end.member.kind == MemberKind::kDiscoveryServer && end.how.number == SIGTERM;
  }
  return end.how.number == 0 || (end.member == kTheWorld && end.how.number == 1);
}

bool IsToComeBack(const MemberEnd& end, unsigned restarts) {
  constexpr int kDone = 0;
  constexpr int kCannotStart = 2;
  constexpr int kNoSuchProgram = 127;
  if (end.planned || restarts >= kMostRestarts) return false;
  if (end.how.by_signal) return true;
  // The world's exit code 1 is its verdict.
  if (end.member == kTheWorld && end.how.number == 1) return false;
  return end.how.number != kDone && end.how.number != kCannotStart &&
         end.how.number != kNoSuchProgram;
}

// As runtime/log.cc writes them: "12:00:00.000 error   vehicle 2: ...", or an object.
bool IsErrorLine(std::string_view line) {
  constexpr std::size_t kTimeChars = 12;
  if (line.starts_with('{')) return line.find("\"level\":\"error\"") != std::string_view::npos;
  return line.size() > kTimeChars && line.substr(kTimeChars).starts_with(" error ");
}

}  // namespace giveway::fleetctl
