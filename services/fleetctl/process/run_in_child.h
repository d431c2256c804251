// Runs a function in a forked copy of this process and returns its result: for what a process can
// do only once, or what may crash it. Call it while this process has no other threads.
#pragma once

#include <functional>
#include <string>

#include "services/types/time.h"

namespace giveway::fleetctl {

struct ChildResult {
  std::string text;
  bool whole = true;  // false: it crashed or took too long; the text may be cut off
};

// The function throws nothing. The child dies with this process, and after `patience`. Throws
// StartError.
ChildResult RunInChild(const std::function<std::string()>& work,
                       Nanoseconds patience = std::chrono::hours(1));

}  // namespace giveway::fleetctl
