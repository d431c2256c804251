// The --help of every program: examples first, then arguments and flags, then the rest of the
// footer, all wrapped to a width. Values are shown as a user writes them: N, 1..99, a|b.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>
#include <string_view>

namespace giveway {

// Columns of the terminal on stdout, at most 120; 80 where stdout is no terminal.
std::size_t HelpColumns();

// Paragraphs of `text` (separated by empty lines) with at most `columns` a line. Lines that start
// with two spaces keep their ends: one that is too long has its "# comment" put on the line above,
// or is continued, indented, on the next.
std::string WrapParagraphs(std::string_view text, std::size_t columns);

// "UINT:UINT in [1 - 99]" as 1..99, "TEXT:{a,b}" as a|b, "UINT" as N.
std::string ValueName(const std::string& type_name);

class HelpFormat : public CLI::Formatter {
 public:
  // 0 columns: as HelpColumns() says when the help is made.
  explicit HelpFormat(std::size_t columns = 0) : columns_(columns) {}
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;

 private:
  std::size_t columns_;
};

}  // namespace giveway
