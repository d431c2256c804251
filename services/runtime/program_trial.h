// A second process of this program that tries what may hang or end it, while the first continues.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

#include "services/runtime/restart.h"
#include "services/types/time.h"

namespace giveway {

class ProgramTrial {
 public:
  // Starts it with the command line of this process, `flags` instead of what it said of them, and
  // under the flag `name` a file that holds `text`. Throws std::system_error.
  ProgramTrial(NewFlags flags, const std::string& name, const std::string& file_name,
               const std::string& text, Nanoseconds patience);
  ~ProgramTrial();  // a process that still runs is killed
  ProgramTrial(const ProgramTrial&) = delete;
  ProgramTrial& operator=(const ProgramTrial&) = delete;

  // Nothing while it runs. Then empty where it ended with 0, else what it said on stdout, or how it
  // ended. Does not wait.
  std::optional<std::string> Result();

 private:
  void Read();
  void Kill();

  pid_t process_ = -1;
  int output_ = -1;
  SteadyTime until_{0};
  std::string said_;
  std::optional<std::string> result_;
};

}  // namespace giveway
