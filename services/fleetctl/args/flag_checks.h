// Validators of flags that several verbs share: each returns an empty string or the error message,
// for CLI11's check(). And the flags common to all verbs that open a link.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "services/types/decision.h"
#include "services/types/discovery_server.h"

namespace giveway::fleetctl {

// Most vehicles of a fleet that a verb starts, and of one that it only calculates for.
inline constexpr std::uint32_t kMostStarted = 1024;
inline constexpr std::uint32_t kMostReckonedWith = 4096;

// The number that is all of the text, if it is finite.
std::optional<double> FiniteNumber(const std::string& text);
// Empty, or why the text is no number from `least` to `most`.
std::string WhyNotBetween(const std::string& text, double least, double most);
// The same for a flag, whose help names the range. CLI11's own range check lets "nan" pass.
CLI::Validator Between(double least, double most);

std::string CheckNotEmpty(const std::string& text);
std::string CheckImpairment(const std::string& text);
// Of an MCAP recording to be written: replay and report know it by its ending.
std::string CheckRecordingName(const std::string& file);

// The behaviour of that name. Throws CLI::ValidationError with all names.
Behaviour ParseBehaviour(const std::string& name);

void AddInterfaceFlag(CLI::App* verb, std::string* interface);
// Servers as HOST[:PORT],...
void AddDiscoveryFlag(CLI::App* verb, std::vector<DiscoveryServer>* servers);

}  // namespace giveway::fleetctl
