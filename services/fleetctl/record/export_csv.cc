#include "services/fleetctl/record/export_csv.h"

#include <algorithm>

namespace giveway::fleetctl {
namespace {

// Parses only text that JsonObject wrote: no white space.
class Walker {
 public:
  explicit Walker(std::string_view json) : rest_(json) {}

  void Object(const std::string& prefix, FlatFields* fields) {
    Skip('{');
    while (!rest_.empty() && rest_.front() != '}') {
      const std::string name = prefix + Text();
      Skip(':');
      if (!rest_.empty() && rest_.front() == '{') {
        Object(name + ".", fields);
      } else {
        fields->emplace_back(name, Value());
      }
      if (!rest_.empty() && rest_.front() == ',') rest_.remove_prefix(1);
    }
    Skip('}');
  }

 private:
  void Skip(char expected) {
    if (!rest_.empty() && rest_.front() == expected) rest_.remove_prefix(1);
  }
  // A string, its escapes left as they are but for quotes and backslashes.
  std::string Text() {
    std::string text;
    Skip('"');
    while (!rest_.empty() && rest_.front() != '"') {
      if (rest_.front() == '\\' && rest_.size() > 1) {
        if (rest_[1] != '"' && rest_[1] != '\\') text += '\\';
        rest_.remove_prefix(1);
      }
      text += rest_.front();
      rest_.remove_prefix(1);
    }
    Skip('"');
    return text;
  }
  std::string Value() {
    if (!rest_.empty() && rest_.front() == '"') return Text();
    int depth = 0;
    std::size_t end = 0;
    for (; end < rest_.size(); ++end) {
      const char c = rest_[end];
      if (depth == 0 && (c == ',' || c == '}')) break;
      if (c == '[') ++depth;
      if (c == ']') --depth;
    }
    std::string value(rest_.substr(0, end));
    rest_.remove_prefix(end);
    return value;
  }

  std::string_view rest_;
};

std::string Cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + "\"";
}

}  // namespace

FlatFields Flattened(std::string_view json) {
  FlatFields fields;
  Walker(json).Object("", &fields);
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
