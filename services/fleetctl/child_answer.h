// What a function tells in a forked copy of this process: for what a process can do only once, or
// what may crash it. Called while this process has no other threads.
#pragma once

#include <functional>
#include <string>

namespace giveway::fleetctl {

struct ChildAnswer {
  std::string text;
  bool whole = true;  // false: the child crashed, and the text may be cut off
};

// `tell` throws nothing. The child dies with this process. Throws StartError.
ChildAnswer AskChild(const std::function<std::string()>& tell);

}  // namespace giveway::fleetctl
