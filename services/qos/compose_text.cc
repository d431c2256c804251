#include "services/qos/compose_text.h"

#include <algorithm>

namespace giveway::qos {
namespace {

constexpr int kDeepest = 8;  // braces within braces

bool IsOfName(char c, bool first) {
  const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  return letter || (!first && c >= '0' && c <= '9');
}

// How many characters at the start of the text are a variable's name.
std::size_t NameLength(std::string_view text) {
  std::size_t length = 0;
  while (length < text.size() && IsOfName(text[length], length == 0)) ++length;
  return length;
}

// Where the brace that is open at `from` is closed; npos if it is not.
std::size_t ClosingBrace(std::string_view text, std::size_t from) {
  int open = 1;
  for (std::size_t i = from; i < text.size(); ++i) {
    if (text[i] == '}' && --open == 0) return i;
    if (text[i] == '{' && text[i - 1] == '$') ++open;
  }
  return std::string_view::npos;
}

std::string_view Trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

// A value as a shell would read it: in quotes, or up to a comment.
std::string_view ValueIn(std::string_view text) {
  if (text.size() >= 2 && (text.front() == '"' || text.front() == '\'')) {
    const std::size_t end = text.find(text.front(), 1);
    if (end != std::string_view::npos) return text.substr(1, end - 1);
  }
  return Trimmed(text.substr(0, text.find(" #")));
}

}  // namespace

std::vector<std::string> EnvFileVariables(std::string_view bytes) {
  constexpr std::string_view kExport = "export ";
  std::vector<std::string> variables;
  while (!bytes.empty()) {
    const std::size_t end = std::min(bytes.find('\n'), bytes.size());
    std::string_view line = Trimmed(bytes.substr(0, end));
    bytes.remove_prefix(std::min(end + 1, bytes.size()));
    if (line.starts_with(kExport)) line = Trimmed(line.substr(kExport.size()));
    const std::size_t name = NameLength(line);
    if (name == 0 || name == line.size() || line[name] != '=') continue;
    variables.push_back(std::string(line.substr(0, name + 1)) +
                        std::string(ValueIn(Trimmed(line.substr(name + 1)))));
  }
  // The last of a name counts.
  std::ranges::reverse(variables);
  return variables;
}

const char* ComposeText::Variable(std::string_view name) const {
  for (const std::string& variable : variables_) {
    if (variable.size() > name.size() && variable[name.size()] == '=' &&
        variable.starts_with(name)) {
      return variable.c_str() + name.size() + 1;
    }
  }
  return nullptr;
}

std::string ComposeText::Expanded(std::string_view text) { return Expanded(text, 0); }

std::string ComposeText::Expanded(std::string_view text, int depth) {
  std::string expanded;
  while (!text.empty()) {
    const std::size_t dollar = std::min(text.find('$'), text.size());
    expanded += text.substr(0, dollar);
    text.remove_prefix(dollar);
    const std::size_t name = text.empty() ? 0 : NameLength(text.substr(1));
    std::size_t taken = std::min<std::size_t>(1, text.size());
    if (text.starts_with("$$")) {
      taken = 2;
      expanded += '$';
    } else if (name > 0) {
      taken = name + 1;
      expanded += ValueOf(text.substr(1, name), depth);
    } else if (const std::size_t end = ClosingBrace(text, 2);
               text.starts_with("${") && end != std::string_view::npos && depth < kDeepest) {
      taken = end + 1;
      expanded += ValueOf(text.substr(2, end - 2), depth + 1);
    } else {
      expanded += text.substr(0, taken);
    }
    text.remove_prefix(taken);
  }
  return expanded;
}

// `inner`: a name, and what stands behind it.
std::string ComposeText::ValueOf(std::string_view inner, int depth) {
  const std::string_view name = inner.substr(0, NameLength(inner));
  std::string_view word = inner.substr(name.size());
  const char* const value = Variable(name);
  const bool empty_too = word.starts_with(':');
  if (empty_too) word.remove_prefix(1);
  const bool is_set = value != nullptr && !(empty_too && *value == '\0');
  const char operation = word.empty() ? ' ' : word.front();
  if (!word.empty()) word.remove_prefix(1);
  if (operation == '+') return is_set ? Expanded(word, depth) : "";
  if (is_set) return value;
  if (operation == '-') return Expanded(word, depth);
  if (operation == '?') missing_.emplace(name);
  return "";
}

}  // namespace giveway::qos
