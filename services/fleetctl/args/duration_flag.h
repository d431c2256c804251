// Flags that take a duration, written as ParseDuration_s of services/config/flag_values.h says.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>

namespace giveway::fleetctl {

// A flag that sets `duration_s`, 0 to 30 days, and leaves it unchanged if it is not given.
CLI::Option* AddDurationFlag(CLI::App* verb, const std::string& name, double* duration_s,
                             const std::string& description);
CLI::Option* AddDurationFlag(CLI::App* verb, const std::string& name,
                             std::optional<double>* duration_s, const std::string& description);

// The same for a time that must be above 0, up to 1 000 000 s.
CLI::Option* AddTimeFlag(CLI::App* verb, const std::string& name,
                         std::function<void(double)> take_s, const std::string& description);
CLI::Option* AddTimeFlag(CLI::App* verb, const std::string& name, double* duration_s,
                         const std::string& description);
CLI::Option* AddTimeFlag(CLI::App* verb, const std::string& name, std::optional<double>* duration_s,
                         const std::string& description);

}  // namespace giveway::fleetctl
