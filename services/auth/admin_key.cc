#include "services/auth/admin_key.h"

#include <fcntl.h>
#include <openssl/rand.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace giveway::auth {
namespace {

// White space after the key, as editors leave it, is no part of it.
constexpr std::size_t kMostReadBytes = 2 * kMostKeyBytes;

constexpr const char* kRemedy =
    "; check the path and its permissions, or make one: openssl rand -hex 32 > FILE";

[[noreturn]] void Throw(const std::string& file, const char* what, const char* remedy = "") {
  throw KeyError("admin key " + file + ": " + what + ": " + std::strerror(errno) + remedy);
}

// Closes what it opened.
class File {
 public:
  explicit File(int descriptor) : descriptor_(descriptor) {}
  ~File() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int Get() const { return descriptor_; }

 private:
  int descriptor_;
};

std::string RandomHex() {
  std::array<std::uint8_t, 32> bytes{};
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1) {
    throw KeyError("OpenSSL has no random bits");
  }
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += kHex[byte >> 4U];
    text += kHex[byte & 15U];
  }
  return text;
}

}  // namespace

std::string ReadAdminKey(const std::string& file) {
  const File input(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (input.Get() < 0) Throw(file, "cannot be read", kRemedy);
  struct stat about {};
  if (fstat(input.Get(), &about) != 0 || !S_ISREG(about.st_mode)) {
    throw KeyError("admin key " + file + ": is no regular file" + kRemedy);
  }
  std::string key(kMostReadBytes, '\0');
  const ssize_t size = read(input.Get(), key.data(), key.size());
  if (size < 0) Throw(file, "cannot be read", kRemedy);
  key.resize(static_cast<std::size_t>(size));
  const bool is_whole = key.size() < kMostReadBytes;
  while (!key.empty() && std::strchr(" \t\r\n", key.back()) != nullptr) key.pop_back();
  if (!is_whole || key.size() > kMostKeyBytes || key.size() < kLeastKeyBytes) {
    const std::string bytes =
        is_whole ? std::to_string(key.size()) : std::to_string(kMostReadBytes) + " or more";
    throw KeyError("admin key " + file + ": has " + bytes + " bytes, must have " +
                   std::to_string(kLeastKeyBytes) + " to " + std::to_string(kMostKeyBytes) +
                   "; make one with: openssl rand -hex 32");
  }
  return key;
}

void MakeAdminKey(const std::string& file) {
  unlink(file.c_str());
  const File output(open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (output.Get() < 0) Throw(file, "cannot be made");
  const std::string text = RandomHex() + "\n";
  if (write(output.Get(), text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
    Throw(file, "cannot be written");
  }
}

}  // namespace giveway::auth
