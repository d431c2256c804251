// Runs gnuplot, if it is installed.
#pragma once

#include <string>

namespace giveway::fleetctl {

inline constexpr const char* kGnuplotIsMissing = "gnuplot is not installed (Debian: gnuplot-nox)";
// Empty if it has executed the program in that file within 20 s, else the reason:
// kGnuplotIsMissing, or gnuplot's last message.
std::string RunGnuplot(const std::string& program_file);

// A text in gnuplot's single quotes, quotes included.
std::string GnuplotQuoted(const std::string& text);

}  // namespace giveway::fleetctl
