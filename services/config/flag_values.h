// The values of flags as they were written, on the command line or in the environment, and what is
// wrong with them. Reads every value before it judges, so that all problems come at once.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/config/problem.h"
#include "services/config/section.h"
#include "services/types/discovery_server.h"

namespace giveway {

// GIVEWAY_LOG_LEVEL of --log-level.
std::string TwinOf(std::string_view flag);

inline constexpr double kLongestDuration_s = 30 * 86400.0;

// A duration as people write it: "90", "90s", "30m", "8h", "2d". In seconds, 0 to
// kLongestDuration_s; nullopt for any other text.
std::optional<double> ParseDuration_s(std::string_view text);

class FlagValues {
 public:
  // `given` maps the flags of the command line to their values.
  explicit FlagValues(std::map<std::string, std::string> given) : given_(std::move(given)) {}

  // The value of a flag, else of its twin; nothing if neither is set.
  std::optional<std::string> Text(const std::string& flag) const;
  // A value that must not be empty, or the fallback.
  std::string TextOr(const std::string& fallback, const std::string& flag);
  // Required text: empty if missing, which is a problem.
  std::string RequiredText(const std::string& flag, const std::string& remedy);
  std::optional<std::uint32_t> Uint(const std::string& flag, const Allowed& allowed);
  std::optional<double> Number(const std::string& flag, const Allowed& allowed);
  // As ParseDuration_s.
  std::optional<double> Duration_s(const std::string& flag, const Allowed& allowed);
  // One of `names`; nothing if not set, or none of them.
  std::optional<std::string> OneOf(const std::string& flag,
                                   std::initializer_list<std::string_view> names);
  // A switch: it or its twin is 1 or true, 0 or false.
  bool Switch(const std::string& flag);

  void AddError(const std::string& flag, std::string message, std::string remedy);
  void Add(const std::vector<Problem>& problems);
  const std::vector<Problem>& Problems() const { return problems_; }

 private:
  std::map<std::string, std::string> given_;
  std::vector<Problem> problems_;
};

// Flags that several programs have.
//
// --discovery-server; none where it is not given.
std::vector<DiscoveryServer> ReadDiscoveryServers(FlagValues* values);
// --qos, a file or the name of a shipped set; the shipped default where it is not given.
std::string ReadQosFlag(FlagValues* values);

}  // namespace giveway
