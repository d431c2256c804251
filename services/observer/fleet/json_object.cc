#include "services/observer/fleet/json_object.h"

#include <fmt/format.h>

#include <cmath>

#include "services/runtime/json_line.h"

namespace giveway {

void JsonObject::Add(std::string_view name, double value) {
  if (std::isfinite(value)) AddRaw(name, fmt::format("{}", value));
}

void JsonObject::Add(std::string_view name, const std::optional<double>& value) {
  if (value) Add(name, *value);
}

void JsonObject::Add(std::string_view name, std::string_view text) {
  AddRaw(name, JsonString(text));
}

void JsonObject::AddRaw(std::string_view name, std::string_view json) {
  if (!fields_.empty()) fields_ += ',';
  fields_ += fmt::format("\"{}\":{}", name, json);
}

}  // namespace giveway
