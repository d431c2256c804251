// A JSON object put together field by field, in one line. Numbers that JSON cannot say (NaN,
// infinity) are left out, as every value that does not exist.
#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <string_view>

namespace giveway {

class JsonObject {
 public:
  template <typename Value>
  requires std::same_as<Value, bool>
  void Add(std::string_view name, Value value) { AddRaw(name, value ? "true" : "false"); }
  template <std::integral Value>
  requires(!std::same_as<Value, bool>) void Add(std::string_view name, Value value) {
    AddRaw(name, std::to_string(value));
  }
  void Add(std::string_view name, double value);
  void Add(std::string_view name, const std::optional<double>& value);
  void Add(std::string_view name, std::string_view text);
  void Add(std::string_view name, const char* text) { Add(name, std::string_view(text)); }
  void Add(std::string_view name, const JsonObject& object) { AddRaw(name, object.Text()); }
  // `json` is put in as it is.
  void AddRaw(std::string_view name, std::string_view json);

  std::string Text() const { return "{" + fields_ + "}"; }

 private:
  std::string fields_;
};

// A JSON array: `of` gives each item's JSON.
template <typename Items, typename Of>
std::string JsonArray(const Items& items, Of&& of) {
  std::string json;
  for (const auto& item : items) json += (json.empty() ? "" : ",") + of(item);
  return "[" + json + "]";
}

}  // namespace giveway
