#include "services/config/text_file.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "services/config/problem.h"
#include "services/runtime/utf8.h"

namespace giveway {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void Refuse(const std::string& path, std::string message, std::string remedy,
                         int line = 0) {
  throw InputError({{path, line, "", "", std::move(message), std::move(remedy)}});
}

void RefuseOddFiles(const std::string& path, std::uintmax_t most_bytes) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) {
    Refuse(path, "does not exist", "check the path");
  }
  if (error) Refuse(path, error.message(), "check the path and its permissions");
  if (status.type() == fs::file_type::directory) {
    Refuse(path, "is a directory", "name a file in it");
  }
  // A pipe or a device may never end.
  if (status.type() != fs::file_type::regular) {
    Refuse(path, "is no regular file", "write the text to a file first");
  }
  const std::uintmax_t bytes = fs::file_size(path, error);
  if (error) Refuse(path, error.message(), "check the path and its permissions");
  if (bytes == 0) Refuse(path, "is empty", "start from a file in config/scenarios");
  if (bytes > most_bytes) {
    Refuse(path, fmt::format("has {} bytes; at most {} are read", bytes, most_bytes),
           "check that this is the file you meant");
  }
}

}  // namespace

int LineNestedTooDeep(std::string_view text) {
  int line = 1;
  int depth = 0;
  char quote = 0;  // of the string we are in
  bool comment = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') {
      ++line;
      quote = 0;  // strings end with their line
      comment = false;
    } else if (comment) {
      continue;
    } else if (quote != 0) {
      if (c == '\\' && i + 1 < text.size() && text[i + 1] != '\n') ++i;
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '#') {
      comment = true;
    } else if (c == '{' || c == '<' || c == '[') {
      if (++depth > kMaxNesting) return line;
    } else if (c == '}' || c == '>' || c == ']') {
      --depth;
    }
  }
  return 0;
}

std::string ReadBytes(const std::string& path, std::uintmax_t most_bytes) {
  RefuseOddFiles(path, most_bytes);
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) Refuse(path, std::strerror(errno), "check its permissions");
  // In parts: a buffer for the largest allowed file would stay allocated with the text.
  std::string text;
  std::array<char, 16384> part;
  while (text.size() < most_bytes) {
    stream.read(part.data(), part.size());
    if (stream.gcount() == 0) break;
    text.append(part.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) Refuse(path, "cannot be read to its end", "check the file");
  return text;
}

std::string ReadTextFile(const std::string& path, std::uintmax_t most_bytes) {
  std::string text = ReadBytes(path, most_bytes);
  if (!IsText(text)) Refuse(path, "is binary, not UTF-8 text", "check that this is the right file");
  if (const int line = LineNestedTooDeep(text); line > 0) {
    Refuse(path, fmt::format("nests deeper than {} brackets", kMaxNesting),
           "close the brackets before", line);
  }
  return text;
}

}  // namespace giveway
