#include "services/link/fastdds/interface_watch.h"

#include <algorithm>
#include <utility>

#include "services/link/fastdds/link_options.h"

namespace giveway::link {
namespace {

// An index of 0 is not known: the system had no socket left to ask with.
bool SameDevice(unsigned a, unsigned b) { return a == b || a == 0 || b == 0; }

bool Same(const Interface& a, const Interface& b) {
  return a.name == b.name && a.address == b.address && SameDevice(a.index, b.index);
}

bool IsAmong(const std::vector<Interface>& list, const Interface& one) {
  return std::ranges::any_of(list, [&](const Interface& other) { return Same(one, other); });
}

// "any" means all but the loopback, which comes and goes with nothing.
bool IsMeant(const std::string& interface, const Interface& one) {
  if (interface == "any") return !one.loopback;
  return one.name == interface || one.address == interface;
}

std::string Listed(const std::vector<Interface>& list) {
  std::string text;
  for (const Interface& one : list) {
    text += (text.empty() ? "" : ", ") + one.name + " (" + one.address + ")";
  }
  return text.empty() ? "none" : text;
}

}  // namespace

std::string ChangeOf(const std::string& interface, const std::vector<Interface>& before,
                     const std::vector<Interface>& now) {
  std::vector<Interface> meant;
  std::ranges::copy_if(before, std::back_inserter(meant),
                       [&](const Interface& one) { return IsMeant(interface, one); });
  const bool all_there =
      std::ranges::all_of(meant, [&](const Interface& one) { return IsAmong(now, one); });
  if (all_there && !meant.empty()) return "";
  // An address that was named may have come back as another, on the interface of the same name.
  std::vector<Interface> come;
  std::ranges::copy_if(now, std::back_inserter(come), [&](const Interface& one) {
    const bool in_place =
        std::ranges::any_of(meant, [&](const Interface& gone) { return gone.name == one.name; });
    return one.up && !IsAmong(before, one) && (in_place || IsMeant(interface, one));
  });
  if (come.empty()) return "";
  return "the network interfaces changed: was " + Listed(meant) + ", is now " + Listed(come);
}

InterfaceWatch::InterfaceWatch(std::string interface)
    : interface_(std::move(interface)), before_(Ipv4Interfaces()) {}

std::string InterfaceWatch::Change() const {
  try {
    return ChangeOf(interface_, before_, Ipv4Interfaces());
  } catch (const LinkError&) {  // no descriptor left, perhaps: that must not end the process
    return "";
  }
}

}  // namespace giveway::link
