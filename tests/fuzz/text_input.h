// What the targets for protobuf text share: a file in memory, for loaders that know files only, and
// what must be true of every refusal.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <string>
#include <vector>

#include "services/config/problem.h"
#include "services/runtime/utf8.h"
#include "services/types/check.h"
#include "tests/fuzz/target.h"

namespace giveway::fuzz {

class MemoryFile {
 public:
  MemoryFile() : descriptor_(memfd_create("input", MFD_CLOEXEC)) {
    GIVEWAY_CHECK(descriptor_ >= 0);
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  void Hold(const std::uint8_t* data, std::size_t size) {
    GIVEWAY_CHECK(ftruncate(descriptor_, 0) == 0);
    GIVEWAY_CHECK(pwrite(descriptor_, data, size, 0) == static_cast<ssize_t>(size));
  }
  std::string Path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

inline void CheckProblems(const InputError& error) {
  GIVEWAY_CHECK(!error.Problems().empty());
  const std::string text = Format(error.Problems());
  GIVEWAY_CHECK(IsText(text), text);
  GIVEWAY_CHECK(text == error.what());
  const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1;
  GIVEWAY_CHECK(lines == error.Problems().size(), lines, text);
  for (const Problem& problem : error.Problems()) {
    GIVEWAY_CHECK(!problem.message.empty() && !problem.remedy.empty() && problem.line >= 0, text);
  }
}

// Every .textproto of the folders, in order.
inline std::vector<Input> TextFilesOf(std::initializer_list<const char*> folders) {
  std::vector<std::filesystem::path> files;
  for (const char* folder : folders) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() == ".textproto") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  std::vector<Input> inputs;
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    inputs.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return inputs;
}

}  // namespace giveway::fuzz
