#include "services/runtime/json.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace giveway {
namespace {

// From here on the library writes an exponent, which is shorter.
constexpr double kMostWhole = 1e16;

bool IsNothing(const Json& json) {
  return json.is_null() || (json.is_number_float() && !std::isfinite(json.get<double>()));
}

void Tidy(Json* json) {
  if (json->is_structured()) {
    for (auto item = json->begin(); item != json->end();) {
      if (json->is_object() && IsNothing(*item)) {
        item = json->erase(item);
      } else {
        Tidy(&*item++);
      }
    }
  } else if (json->is_number_float()) {
    const auto value = json->get<double>();
    const bool negative_zero = value == 0 && std::signbit(value);
    if (std::abs(value) < kMostWhole && value == std::trunc(value) && !negative_zero) {
      *json = static_cast<std::int64_t>(value);
    }
  }
}

}  // namespace

std::string JsonText(Json json) {
  Tidy(&json);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<Json> ReadJson(std::string_view text) {
  bool too_deep = false;
  const auto keep = [&too_deep](int depth, Json::parse_event_t event, Json&) {
    const bool opens =
        event == Json::parse_event_t::object_start || event == Json::parse_event_t::array_start;
    too_deep = too_deep || (opens && depth >= kMostJsonDepth);
    return !too_deep;
  };
  Json json = Json::parse(text, keep, false);
  if (too_deep || json.is_discarded()) return std::nullopt;
  return json;
}

std::uint32_t Uint32Of(const Json& json) {
  const auto* number = json.get_ptr<const Json::number_unsigned_t*>();
  if (number == nullptr || *number > std::numeric_limits<std::uint32_t>::max()) {
    throw std::range_error("no whole number of 0 to 4294967295");
  }
  return static_cast<std::uint32_t>(*number);
}

}  // namespace giveway
