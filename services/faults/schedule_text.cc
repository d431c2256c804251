#include "services/faults/schedule_text.h"

#include <array>
#include <charconv>
#include <cmath>

#include "services/faults/kind_table.h"
#include "services/types/check.h"

namespace giveway::faults {
namespace {

// Within double quotes of protobuf text.
std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

void AppendTarget(const Target& target, std::string* text) {
  if (target.what == Target::What::kVehicle) {
    *text += " vehicle: " + std::to_string(Number(target.vehicle));
  } else {
    *text += " target: " + Quoted(std::string(ToString(target.what)));
  }
}

// Each as `name`, `between`, value, with a space before it.
std::string Listed(const Parameters& parameters, const char* between) {
  std::string text;
  for (std::size_t i = 0; i < kQuantities; ++i) {
    const auto quantity = static_cast<Quantity>(i);
    const auto value = Get(parameters, quantity);
    if (!value) continue;
    text += ' ' + std::string(FieldOf(quantity)) + between + NumberText(*value);
  }
  if (parameters.from)
    text += std::string(" from") + between + std::to_string(Number(*parameters.from));
  if (!parameters.qos.empty()) text += std::string(" qos") + between + Quoted(parameters.qos);
  return text;
}

}  // namespace

std::string NumberText(double value) {
  std::array<char, 32> text;
  const double size = std::abs(value);
  const bool plain = size == 0 || (size >= 1e-5 && size < 1e15);
  const auto written = std::to_chars(text.data(), text.data() + text.size(), value,
                                     plain ? std::chars_format::fixed : std::chars_format::general);
  GIVEWAY_CHECK(written.ec == std::errc{});
  return {text.data(), written.ptr};
}

std::string SecondsText(double time_s) { return NumberText(std::round(time_s * 1000) / 1000); }

std::string ParametersText(const Parameters& parameters) {
  const std::string listed = Listed(parameters, "=");
  return listed.empty() ? "" : listed.substr(1);
}

std::string Line(const Fault& fault) {
  std::string text = SecondsText(fault.at_s) + " s";
  if (RowOf(fault.kind).takes_time) text += " for " + SecondsText(fault.for_s) + " s";
  return text + ": " + ToString(fault.target) + ": " + std::string(ToString(fault.kind)) +
         Listed(fault.parameters, "=");
}

std::string AsTextproto(const Schedule& schedule) {
  if (schedule.empty()) return "description: \"No fault.\"\n";
  std::string text;
  for (const Fault& fault : schedule) {
    text += "at { name: " + Quoted(fault.rule);
    if (fault.nth > 0) text += " nth: " + std::to_string(fault.nth);
    text += " time_s: " + NumberText(fault.at_s) +
            " kind: " + Quoted(std::string(ToString(fault.kind)));
    AppendTarget(fault.target, &text);
    if (RowOf(fault.kind).takes_time) text += " for_s: " + NumberText(fault.for_s);
    text += Listed(fault.parameters, ": ") + " }\n";
  }
  return text;
}

}  // namespace giveway::faults
