#include "services/runtime/identity.h"

#include <sys/mman.h>
#include <unistd.h>

#include <charconv>
#include <fstream>

namespace giveway {
namespace {

constexpr const char* kIdentity = "giveway-identity";
constexpr const char* kHeap = "giveway-heap";
constexpr std::string_view kVehicle = "vehicle ";
constexpr std::string_view kParticipant = "\nparticipant ";
constexpr std::size_t kMostBytes = 128;

bool IsHexadecimal(std::string_view text) {
  return text.find_first_not_of("0123456789abcdef") == text.npos;
}

// Longer or shorter by a digit: for a reader in between the last byte is not a line's end.
void Publish(int descriptor, const std::string& text) {
  if (descriptor < 0 || ftruncate(descriptor, 0) != 0) return;
  [[maybe_unused]] const ssize_t written = pwrite(descriptor, text.data(), text.size(), 0);
}

// Empty where the process publishes nothing of this name, or may not be read.
std::string ReadPublished(const std::filesystem::path& process, const char* name) {
  namespace fs = std::filesystem;
  std::error_code error;
  for (fs::directory_iterator file(process / "fd", error), end; !error && file != end;
       file.increment(error)) {
    std::error_code unreadable;
    const std::string link = fs::read_symlink(file->path(), unreadable).filename().string();
    if (!link.starts_with(std::string("memfd:") + name)) continue;
    std::ifstream stream(file->path(), std::ios::binary);
    std::string text(kMostBytes, '\0');
    stream.read(text.data(), kMostBytes);
    text.resize(static_cast<std::size_t>(stream.gcount()));
    return text;
  }
  return {};
}

}  // namespace

std::string ToText(const Identity& identity) {
  return std::string(kVehicle) + std::to_string(Number(identity.vehicle)) +
         std::string(kParticipant) + identity.participant + '\n';
}

std::optional<Identity> ParseIdentity(std::string_view text) {
  if (!text.starts_with(kVehicle) || !text.ends_with('\n')) return std::nullopt;
  text.remove_prefix(kVehicle.size());
  text.remove_suffix(1);
  std::uint32_t vehicle = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), vehicle);
  if (error != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  if (!text.starts_with(kParticipant)) return std::nullopt;
  text.remove_prefix(kParticipant.size());
  if (text.size() != 24 || !IsHexadecimal(text)) return std::nullopt;
  return Identity{VehicleId{vehicle}, std::string(text)};
}

void PublishIdentity(const Identity& identity) {
  static const int descriptor = memfd_create(kIdentity, MFD_CLOEXEC);
  Publish(descriptor, ToText(identity));
}

std::optional<Identity> ReadIdentity(const std::filesystem::path& process) {
  return ParseIdentity(ReadPublished(process, kIdentity));
}

void PublishHeap(std::uint64_t bytes) {
  static const int descriptor = memfd_create(kHeap, MFD_CLOEXEC);
  Publish(descriptor, std::to_string(bytes) + '\n');
}

std::optional<std::uint64_t> ReadHeap(const std::filesystem::path& process) {
  const std::string text = ReadPublished(process, kHeap);
  std::uint64_t bytes = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), bytes);
  const bool whole = error == std::errc{} && text.ends_with('\n') && *end == '\n';
  return whole ? std::optional(bytes) : std::nullopt;
}

}  // namespace giveway
