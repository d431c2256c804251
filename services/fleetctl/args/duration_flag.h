// Durations as people write them on the command line: "90", "90s", "30m", "8h", "2d".
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace giveway::fleetctl {

inline constexpr double kLongestDuration_s = 30 * 86400.0;

// In seconds, 0 to kLongestDuration_s; nullopt for any other text.
std::optional<double> ParseDuration_s(std::string_view text);

// A flag that sets `duration_s`, and leaves it unchanged if it is not given.
CLI::Option* AddDurationFlag(CLI::App* verb, const std::string& name, double* duration_s,
                             const std::string& description);

// The same for a time that must be above 0, up to 1 000 000 s.
CLI::Option* AddTimeFlag(CLI::App* verb, const std::string& name,
                         std::function<void(double)> take_s, const std::string& description);
CLI::Option* AddTimeFlag(CLI::App* verb, const std::string& name, double* duration_s,
                         const std::string& description);
CLI::Option* AddTimeFlag(CLI::App* verb, const std::string& name, std::optional<double>* duration_s,
                         const std::string& description);

}  // namespace giveway::fleetctl
