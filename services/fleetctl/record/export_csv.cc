#include "services/fleetctl/record/export_csv.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "services/runtime/utf8.h"

namespace giveway::fleetctl {
namespace {

// Control characters of a string stay as JSON writes them: a row is a line.
std::string Plain(const Json& value) {
  if (!value.is_string()) return JsonText(value);
  std::string plain;
  for (const char c : WellFormed(value.get_ref<const std::string&>())) {
    const bool is_control = static_cast<unsigned char>(c) < 0x20;
    const std::string text(1, c);
    const std::string json = is_control ? JsonText(text) : "";
    plain += is_control ? json.substr(1, json.size() - 2) : text;
  }
  return plain;
}

void Flatten(const Json& object, const std::string& prefix, FlatFields* fields) {
  for (const auto& [name, value] : object.items()) {
    if (value.is_object()) {
      Flatten(value, prefix + name + ".", fields);
    } else if (std::string plain = Plain(value); plain != "null" || value.is_string()) {
      fields->emplace_back(prefix + name, std::move(plain));
    }
  }
}

std::string Cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + "\"";
}

}  // namespace

FlatFields Flattened(const Json& sample) {
  FlatFields fields;
  Flatten(sample, "", &fields);
  return fields;
}

void CsvColumns::Add(const FlatFields& fields) {
  for (const auto& [name, value] : fields) {
    if (std::ranges::find(names_, name) == names_.end()) names_.push_back(name);
  }
}

std::string CsvColumns::Head() const {
  std::string text;
  for (const std::string& name : names_) text += (text.empty() ? "" : ",") + Cell(name);
  return text + "\n";
}

std::string CsvColumns::Row(const FlatFields& fields) const {
  std::string text;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const auto field = std::ranges::find(fields, names_[i], &FlatFields::value_type::first);
    if (i != 0) text += ",";
    if (field != fields.end()) text += Cell(field->second);
  }
  return text + "\n";
}

}  // namespace giveway::fleetctl
