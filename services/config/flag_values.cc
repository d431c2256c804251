#include "services/config/flag_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "services/config/config_dir.h"

namespace giveway {
namespace {

// The whole of `text` as a number, or nothing.
template <typename T>
std::optional<T> Parse(const std::string& text) {
  T value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

}  // namespace

std::string TwinOf(std::string_view flag) {
  std::string name = "GIVEWAY_";
  for (const char c : flag.substr(2)) {
    name += c == '-' ? '_' : static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
  }
  return name;
}

std::optional<double> ParseDuration_s(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, double>, 4> kUnits = {
      {{"s", 1}, {"m", 60}, {"h", 3600}, {"d", 86400}}};
  double unit_s = 1;
  for (const auto& [name, seconds] : kUnits) {
    if (!text.ends_with(name)) continue;
    text.remove_suffix(name.size());
    unit_s = seconds;
    break;
  }
  double number = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || stop != end) return std::nullopt;
  const double duration_s = number * unit_s;
  if (!(duration_s >= 0 && duration_s <= kLongestDuration_s)) return std::nullopt;  // nan, too
  return duration_s;
}

std::optional<std::string> FlagValues::Text(const std::string& flag) const {
  if (const auto found = given_.find(flag); found != given_.end()) return found->second;
  const char* twin = std::getenv(TwinOf(flag).c_str());
  if (twin == nullptr || *twin == '\0') return std::nullopt;
  return twin;
}

std::string FlagValues::TextOr(const std::string& fallback, const std::string& flag) {
  const std::string text = Text(flag).value_or(fallback);
  if (text.empty()) AddError(flag, "must not be empty", "write a value or leave the flag out");
  return text;
}

std::string FlagValues::RequiredText(const std::string& flag, const std::string& remedy) {
  const std::string text = Text(flag).value_or("");
  if (text.empty()) AddError(flag, "is required and missing", remedy);
  return text;
}

std::optional<std::uint32_t> FlagValues::Uint(const std::string& flag, const Allowed& allowed) {
  const auto text = Text(flag);
  if (!text) return std::nullopt;
  const auto value = Parse<std::uint32_t>(*text);
  if (value && allowed.Contains(*value)) return value;
  // Printed as whole numbers: 4294967295 would come out as 4.29e9.
  const std::string range = fmt::format("between {:.0f} and {:.0f}", allowed.low, allowed.high);
  AddError(flag, "must be a whole number " + range, "write one in that range");
  return std::nullopt;
}

std::optional<double> FlagValues::Number(const std::string& flag, const Allowed& allowed) {
  const auto text = Text(flag);
  if (!text) return std::nullopt;
  const auto value = Parse<double>(*text);
  if (value && std::isfinite(*value) && allowed.Contains(*value)) return value;
  AddError(flag, "must be a number " + Describe(allowed), "write one in that range");
  return std::nullopt;
}

std::optional<double> FlagValues::Duration_s(const std::string& flag, const Allowed& allowed) {
  const auto text = Text(flag);
  if (!text) return std::nullopt;
  const auto value_s = ParseDuration_s(*text);
  if (value_s && allowed.Contains(*value_s)) return value_s;
  AddError(flag, "must be a time " + Describe(allowed), "write one such as 90, 90s or 30m");
  return std::nullopt;
}

std::optional<std::string> FlagValues::OneOf(const std::string& flag,
                                             std::initializer_list<std::string_view> names) {
  const auto text = Text(flag);
  if (!text || std::find(names.begin(), names.end(), *text) != names.end()) return text;
  AddError(flag, fmt::format("must be one of {}", fmt::join(names, ", ")),
           "write one of these names");
  return std::nullopt;
}

bool FlagValues::Switch(const std::string& flag) {
  const std::string text = OneOf(flag, {"0", "1", "false", "true"}).value_or("0");
  return text == "1" || text == "true";
}

void FlagValues::AddError(const std::string& flag, std::string message, std::string remedy) {
  const auto value = Text(flag);
  const bool from_environment = value && !given_.contains(flag);
  problems_.push_back({from_environment ? "environment" : "command line", 0,
                       from_environment ? TwinOf(flag) : flag,
                       value && value->empty() ? "\"\"" : value.value_or(""), std::move(message),
                       std::move(remedy)});
}

void FlagValues::Add(const std::vector<Problem>& problems) {
  problems_.insert(problems_.end(), problems.begin(), problems.end());
}

std::vector<DiscoveryServer> ReadDiscoveryServers(FlagValues* values) {
  const auto text = values->Text("--discovery-server");
  if (!text) return {};
  ParsedDiscoveryServers parsed = ParseDiscoveryServers(*text);
  if (!parsed.fault.empty()) {
    values->AddError("--discovery-server", parsed.fault,
                     "write HOST or HOST:PORT, several with commas between them");
  }
  return std::move(parsed.servers);
}

std::string ReadQosFlag(FlagValues* values) {
  const std::string set = values->TextOr("default", "--qos");
  if (set.empty()) return "";
  try {
    if (!values->Text("--qos")) return ConfigDir() + "/qos/default.xml";
    return ResolveQosFile(set);
  } catch (const InputError& error) {
    values->Add(error.Problems());
    return "";
  }
}

}  // namespace giveway
