#include "services/app/state_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace giveway::app {
namespace {

std::string Complaint(const std::string& path, const char* what) {
  return path + ": " + what + ": " + std::strerror(errno);
}

}  // namespace

std::optional<std::string> ReadStateFile(const std::string& path) {
  if (access(path.c_str(), F_OK) != 0 && errno == ENOENT) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw std::runtime_error(Complaint(path, "cannot be read"));
  return bytes;
}

std::string WriteStateFile(const std::string& path, std::string_view bytes) {
  const std::string beside = path + ".new";
  const int file = open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) return Complaint(beside, "cannot be written");
  const ssize_t written = write(file, bytes.data(), bytes.size());
  const bool whole = written == static_cast<ssize_t>(bytes.size());
  const std::string complaint = whole ? "" : Complaint(beside, "cannot be written");
  close(file);
  if (!whole) return complaint;
  if (rename(beside.c_str(), path.c_str()) != 0) return Complaint(path, "cannot be replaced");
  return {};
}

void RemoveStateFile(const std::string& path) { std::remove(path.c_str()); }

}  // namespace giveway::app
