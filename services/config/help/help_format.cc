#include "services/config/help/help_format.h"

#include <algorithm>
#include <regex>
#include <vector>

#include "services/runtime/terminal_size.h"

namespace giveway {
namespace {

constexpr std::size_t kLeastColumns = 40;
constexpr std::size_t kMostColumns = 120;  // longer lines are hard to read
constexpr std::size_t kNameColumns = 26;   // of the left column, names of flags
constexpr std::size_t kHanging = 4;

std::vector<std::string> Lines(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::vector<std::string> Words(std::string_view text) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : text) {
    if (c != ' ' && c != '\n') {
      word += c;
    } else if (!word.empty()) {
      words.push_back(std::move(word));
      word.clear();
    }
  }
  if (!word.empty()) words.push_back(std::move(word));
  return words;
}

// The first line follows `head`, the others start with `indent` spaces; each ends with `broken` but
// the last.
std::string Wrapped(const std::string& head, std::string_view text, std::size_t indent,
                    std::size_t columns, const std::string& broken = "") {
  std::string out;
  std::string line = head;
  bool empty = true;
  for (const std::string& word : Words(text)) {
    if (!empty && line.size() + 1 + word.size() + broken.size() > columns) {
      out += line + broken + "\n";
      line.assign(indent, ' ');
      empty = true;
    }
    line += (empty ? "" : " ") + word;
    empty = false;
  }
  return out + line + "\n";
}

// A line with its own layout.
std::string Kept(const std::string& line, std::size_t columns) {
  if (line.size() <= columns) return line + "\n";
  const std::size_t indent = line.find_first_not_of(' ');
  const std::string margin(indent, ' ');
  const std::size_t comment = line.find("  #");
  if (comment != std::string::npos && comment > indent) {
    const std::size_t text = line.find('#', comment) + 1;
    std::string lines;
    for (const auto& one : Lines(Wrapped("", line.substr(text), 0, columns - indent - 2))) {
      lines += margin + "# " + one + "\n";
    }
    return lines + Kept(line.substr(0, line.find_last_not_of(' ', comment) + 1), columns);
  }
  const bool is_command = line.find("fleetctl ") != std::string::npos;
  return Wrapped(margin, line, indent + kHanging, columns, is_command ? " \\" : "");
}

std::string WrappedParagraph(const std::vector<std::string>& lines, std::size_t columns) {
  std::string out;
  std::string text;
  const auto flush = [&] {
    if (!text.empty()) out += Wrapped("", text, 0, columns);
    text.clear();
  };
  for (const std::string& line : lines) {
    if (line.starts_with("  ")) {
      flush();
      out += Kept(line, columns);
    } else {
      text += line + "\n";
    }
  }
  flush();
  return out;
}

bool IsExamples(const std::vector<std::string>& paragraph) {
  return !paragraph.empty() && paragraph.front().starts_with("Example");
}

std::vector<std::vector<std::string>> Paragraphs(std::string_view text) {
  std::vector<std::vector<std::string>> paragraphs(1);
  for (const std::string& line : Lines(text)) {
    if (!line.empty()) {
      paragraphs.back().push_back(line);
    } else if (!paragraphs.back().empty()) {
      paragraphs.emplace_back();
    }
  }
  if (paragraphs.back().empty()) paragraphs.pop_back();
  return paragraphs;
}

std::string Row(const std::string& name, const std::string& text, std::size_t columns) {
  constexpr std::size_t kIndent = kNameColumns + 2;
  if (name.size() + 2 <= kNameColumns) {
    return Wrapped(name + std::string(kIndent - name.size(), ' '), text, kIndent, columns);
  }
  return name + "\n" + Wrapped(std::string(kIndent, ' '), text, kIndent, columns);
}

// The first name alone: the others are what the flag was called before.
std::string FlagName(const CLI::Option& option) {
  const auto& longs = option.get_lnames();
  const auto& shorts = option.get_snames();
  std::string name = "  ";
  if (!shorts.empty()) name += "-" + shorts.front() + (longs.empty() ? "" : ", ");
  if (!longs.empty()) name += "--" + longs.front();
  if (option.get_type_size() == 0) return name;
  name += " " + ValueName(option.get_type_name());
  if (option.get_expected_max() >= CLI::detail::expected_max_vector_size) name += "...";
  return name;
}

std::string Explanation(const CLI::Option& option) {
  std::string text = option.get_description();
  if (option.get_required() && !option.get_positional()) text += " (required)";
  if (option.get_type_size() != 0 && !option.get_default_str().empty()) {
    text += " [" + option.get_default_str() + "]";
  }
  if (!option.get_envname().empty()) text += " [" + option.get_envname() + "]";
  return text;
}

std::string Options(const CLI::App& app, bool positional, std::size_t columns) {
  std::string rows;
  for (const CLI::Option* option :
       app.get_options([](const CLI::Option* shown) { return !shown->get_group().empty(); })) {
    if (positional ? !option->get_positional() : !option->nonpositional()) continue;
    const std::string name = positional ? "  " + option->get_name(true, false) : FlagName(*option);
    rows += Row(name, Explanation(*option), columns);
  }
  if (rows.empty()) return "";
  return std::string(positional ? "\nArguments:\n" : "\nFlags:\n") + rows;
}

std::string Verbs(const CLI::App& app, std::size_t columns) {
  std::string rows;
  for (const CLI::App* verb :
       app.get_subcommands([](const CLI::App* shown) { return !shown->get_group().empty(); })) {
    rows += Row("  " + verb->get_name(), verb->get_description(), columns);
  }
  return rows.empty() ? "" : "\nVerbs:\n" + rows;
}

std::string Usage(const CLI::App& app, const std::string& name) {
  std::string usage = "Usage: " + name;
  const bool has_verbs = !app.get_subcommands([](const CLI::App*) { return true; }).empty();
  if (has_verbs) usage += " VERB";
  for (const CLI::Option* option :
       app.get_options([](const CLI::Option* argument) { return argument->get_positional(); })) {
    const std::string name_of_one = option->get_name(true, false);
    const bool many = option->get_expected_max() >= CLI::detail::expected_max_vector_size;
    const std::string word = name_of_one + (many ? "..." : "");
    usage += option->get_required() ? " " + word : " [" + word + "]";
    for (int i = option->get_expected_min(); !many && i < option->get_expected_max(); ++i) {
      usage += " [" + name_of_one + "]";
    }
  }
  return usage + " [FLAGS]";
}

}  // namespace

std::size_t HelpColumns() {
  const auto columns = static_cast<std::size_t>(SizeOfTerminal().columns);
  return std::clamp(columns, kLeastColumns, kMostColumns);
}

std::string WrapParagraphs(std::string_view text, std::size_t columns) {
  std::string out;
  for (const auto& paragraph : Paragraphs(text)) {
    out += (out.empty() ? "" : "\n") + WrappedParagraph(paragraph, columns);
  }
  return out;
}

std::string ValueName(const std::string& type_name) {
  static const std::regex kRange(R"(\w+:(?:UINT|INT|FLOAT) in \[(\S+) - (\S+)\])");
  static const std::regex kMembers(R"(\w+:\{(.*)\})");
  std::smatch part;
  if (std::regex_match(type_name, part, kRange)) {
    constexpr std::size_t kMostDigits = 9;  // a bound of more is that of the number's type
    return part[2].length() > static_cast<std::ptrdiff_t>(kMostDigits)
               ? "N"
               : part[1].str() + ".." + part[2].str();
  }
  if (std::regex_match(type_name, part, kMembers)) {
    std::string members = part[1];
    std::replace(members.begin(), members.end(), ',', '|');
    return members;
  }
  if (type_name == "UINT" || type_name == "INT") return "N";
  if (type_name == "FLOAT") return "NUMBER";
  return type_name;
}

std::string HelpFormat::make_help(const CLI::App* app, std::string name,
                                  CLI::AppFormatMode /*mode*/) const {
  const std::size_t columns = columns_ > 0 ? columns_ : HelpColumns();
  std::string examples;
  std::string rest;
  for (auto& paragraph : Paragraphs(app->get_footer())) {
    const bool is_first = IsExamples(paragraph);
    if (is_first) paragraph.front() = "Examples:";
    (is_first ? examples : rest) += "\n" + WrappedParagraph(paragraph, columns);
  }
  return WrapParagraphs(app->get_description(), columns) + "\n" +
         Wrapped("", Usage(*app, name), kHanging, columns) + examples +
         Options(*app, true, columns) + Verbs(*app, columns) + Options(*app, false, columns) + rest;
}

}  // namespace giveway
