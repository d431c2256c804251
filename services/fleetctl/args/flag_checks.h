// What several verbs ask of the text of a flag: empty if it is right, else what is wrong, for
// CLI11's check(). And the flags that all who open a link have alike.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "services/types/discovery_server.h"

namespace giveway::fleetctl {

// Vehicles of a fleet that a verb starts, and of one that it only reckons with.
inline constexpr std::uint32_t kMostStarted = 1024;
inline constexpr std::uint32_t kMostReckonedWith = 4096;

std::string CheckNotEmpty(const std::string& text);
std::string CheckImpairment(const std::string& text);

void AddInterfaceFlag(CLI::App* verb, std::string* interface);
// Servers as HOST[:PORT],...
void AddDiscoveryFlag(CLI::App* verb, std::vector<DiscoveryServer>* servers);

}  // namespace giveway::fleetctl
