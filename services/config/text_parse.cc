#include "services/config/text_parse.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "services/runtime/utf8.h"

namespace giveway {
namespace {

constexpr std::size_t kShownOfLine = 60;  // of a line

// The parts of a message that stand in double quotes.
std::vector<std::string> Quoted(const std::string& message) {
  std::vector<std::string> parts;
  std::size_t open = message.find('"');
  while (open != std::string::npos) {
    const std::size_t close = message.find('"', open + 1);
    if (close == std::string::npos) break;
    parts.push_back(message.substr(open + 1, close - open - 1));
    open = message.find('"', close + 1);
  }
  return parts;
}

std::string FieldsOf(const std::string& type) {
  const auto* message =
      google::protobuf::DescriptorPool::generated_pool()->FindMessageTypeByName(type);
  std::string names;
  for (int i = 0; message != nullptr && i < message->field_count(); ++i) {
    names += (i == 0 ? "" : ", ") + message->field(i)->name();
  }
  return names;
}

// The names an enum field of that name takes, in whatever message of the schema it stands.
std::string NamesOf(const std::string& field) {
  const auto* pool = google::protobuf::DescriptorPool::generated_pool();
  const auto* scenario = pool->FindMessageTypeByName("giveway.schema.Scenario");
  std::string names;
  for (int i = 0; scenario != nullptr && i < scenario->file()->message_type_count(); ++i) {
    const auto* found = scenario->file()->message_type(i)->FindFieldByName(field);
    if (found == nullptr || found->enum_type() == nullptr) continue;
    for (int k = 0; k < found->enum_type()->value_count(); ++k) {
      names += (k == 0 ? "" : ", ") + found->enum_type()->value(k)->name();
    }
    return names;
  }
  return names;
}

// The line, from 0, of the last `word` that starts before a line; the parser has read past it.
int LineOfWordBefore(const std::string& text, const std::string& word, int line) {
  std::size_t end = 0;  // of the line
  for (int i = 0; i <= line && end != std::string::npos; ++i) end = text.find('\n', end + 1);
  const std::size_t at = text.rfind(word, end);
  if (at == std::string::npos) return line;
  const auto stop = text.begin() + static_cast<std::ptrdiff_t>(at);
  return static_cast<int>(std::count(text.begin(), stop, '\n'));
}

std::string LineOf(const std::string& text, int line) {
  std::size_t begin = 0;
  for (; line > 0 && begin != std::string::npos; --line) {
    begin = text.find('\n', begin);
    if (begin != std::string::npos) ++begin;
  }
  if (begin == std::string::npos) return "";
  std::string found = text.substr(begin, text.find('\n', begin) - begin);
  const std::size_t first = found.find_first_not_of(" \t");
  const std::size_t last = found.find_last_not_of(" \t\r");
  if (first == std::string::npos) return "";
  return Shortened(found.substr(first, last - first + 1), kShownOfLine);
}

// The parser's words fit for showing: of a character it did not expect it names one byte only.
std::string Worded(const std::string& message) {
  return Shortened(WellFormed(message), 3 * kShownOfLine);
}

// The words are the parser's own: "Message type "T" has no field named "f"."
Problem UnknownField(const std::string& message) {
  const std::vector<std::string> parts = Quoted(message);
  Problem problem;
  if (parts.size() != 2) {
    problem.message = Worded(message);
    problem.remedy = "remove it";
    return problem;
  }
  problem.field = Shortened(parts[1], kShownOfLine);
  problem.message = fmt::format("is no field of {}", parts[0].substr(parts[0].rfind('.') + 1));
  problem.remedy = fmt::format("remove it, or write one of {}", FieldsOf(parts[0]));
  return problem;
}

// The words are the parser's own: "Unknown enumeration value of "V" for field "F".".
std::optional<Problem> UnknownName(const std::string& text, int line, const std::string& message) {
  const std::vector<std::string> parts = Quoted(message);
  if (!message.starts_with("Unknown enumeration value") || parts.size() != 2) return std::nullopt;
  const int written = LineOfWordBefore(text, parts[0], line);
  return Problem{
      .line = written + 1,
      .field = Shortened(parts[1], kShownOfLine),
      .value = LineOf(text, written),
      .message = "is none of its names",
      .remedy = fmt::format("write one of {}; nothing after it was read", NamesOf(parts[1]))};
}

}  // namespace

Problem ParserProblem(const std::string& file, const std::string& text, int line, int column,
                      const std::string& message, bool unknown_field) {
  Problem problem;
  if (auto unknown_name = UnknownName(text, line, message)) {
    unknown_name->file = file;
    return *unknown_name;
  }
  if (unknown_field) {
    problem = UnknownField(message);
  } else {
    problem.message = fmt::format("column {}: {}", column + 1, Worded(message));
    problem.remedy = "correct this first: nothing after it was read";
  }
  problem.file = file;
  problem.line = line + 1;
  problem.value = LineOf(text, line);
  return problem;
}

}  // namespace giveway
