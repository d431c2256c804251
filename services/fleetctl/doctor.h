// The verb `fleetctl doctor`: the host a fleet runs on, examined before or while it runs. Starts
// nothing and speaks to nobody; only with `fix` something is changed. Values in; the exit code out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace giveway::fleetctl {

struct DoctorOptions {
  std::optional<std::uint32_t> domain;  // its processes alone; without it all, else the first
  std::uint32_t vehicles = 2;           // that are to run
  std::string qos;                      // a file, or a shipped set; empty: the default
  std::string interface = "127.0.0.1";
  bool fix = false;  // remove files in shared memory that nobody uses
  bool json = false;
  bool quiet = false;  // the exit code alone
};

// 0 nothing found, 1 something (left, with `fix`), 2 could not examine. Throws InputError,
// LinkError.
int RunDoctor(const DoctorOptions& options);

}  // namespace giveway::fleetctl
