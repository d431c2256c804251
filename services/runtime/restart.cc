#include "services/runtime/restart.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "services/runtime/hang_signal.h"
#include "services/runtime/process.h"

namespace giveway {
namespace {

constexpr std::string_view kHeldFolder = "/proc/self/fd/";
constexpr std::size_t kMostNameBytes = 200;  // the kernel takes 249

std::vector<std::string> ReadOwnArguments() {
  std::ifstream stream("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> arguments;
  for (std::string word; std::getline(stream, word, '\0');) arguments.push_back(word);
  return arguments;
}

// Read before main: a process that has no descriptor left could not, and would restart with none.
const std::vector<std::string> own_arguments = ReadOwnArguments();

[[noreturn]] void ThrowErrno(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

// The descriptor of a held text; -1 if the path is none.
int HeldDescriptor(const std::string& path) {
  int number = -1;
  if (!path.starts_with(kHeldFolder)) return -1;
  const std::string_view digits = std::string_view(path).substr(kHeldFolder.size());
  const auto read = std::from_chars(digits.begin(), digits.end(), number);
  return read.ec == std::errc() && read.ptr == digits.end() ? number : -1;
}

std::string PathOf(int descriptor) { return std::string(kHeldFolder) + std::to_string(descriptor); }

int MakeHeld(const std::string& name, const std::string& text) {
  const int descriptor = memfd_create(name.substr(0, kMostNameBytes).c_str(), 0);
  if (descriptor < 0) ThrowErrno("cannot hold a text in memory");
  std::ofstream stream(PathOf(descriptor), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) {
    const int why = errno;
    close(descriptor);  // it would stay open in each process image to come
    errno = why;
    ThrowErrno("cannot hold a text in memory");
  }
  return descriptor;
}

struct OpenDescriptor {
  int number;
  bool held;
};

std::vector<OpenDescriptor> OpenDescriptors() {
  namespace fs = std::filesystem;
  std::vector<OpenDescriptor> found;
  std::error_code error;
  for (const fs::directory_entry& open : fs::directory_iterator(kHeldFolder, error)) {
    const int descriptor = HeldDescriptor(open.path());
    if (descriptor <= STDERR_FILENO) continue;
    const bool held = fs::read_symlink(open.path(), error).string().starts_with("/memfd:");
    found.push_back({descriptor, held});
  }
  return found;
}

}  // namespace

std::vector<std::string> OwnArguments() { return own_arguments; }

std::vector<std::string> ArgumentsWith(const std::vector<std::string>& arguments,
                                       const NewFlags& flags) {
  std::vector<std::string> kept;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string name = arguments[i].substr(0, arguments[i].find('='));
    if (flags.contains(name)) {
      if (name == arguments[i]) ++i;  // its value is the next word
    } else {
      kept.push_back(arguments[i]);
    }
  }
  for (const auto& [name, value] : flags) {
    if (value.empty()) continue;
    kept.push_back(name);
    kept.push_back(value);
  }
  return kept;
}

void HoldSignalsBack() {
  sigset_t stops;
  sigemptyset(&stops);
  sigaddset(&stops, SIGINT);
  sigaddset(&stops, SIGTERM);
  sigaddset(&stops, HangSignal::kHang);
  sigaddset(&stops, HangSignal::kResume);
  sigprocmask(SIG_BLOCK, &stops, nullptr);
}

std::vector<int> HeldDescriptors() {
  std::vector<int> held;
  for (const OpenDescriptor& open : OpenDescriptors()) {
    if (open.held) held.push_back(open.number);
  }
  std::ranges::sort(held);
  return held;
}

void LeaveOpenOnlyHeld() {
  for (const OpenDescriptor& open : OpenDescriptors()) {
    if (!open.held) fcntl(open.number, F_SETFD, FD_CLOEXEC);
  }
}

void RestartWith(const NewFlags& flags) {
  std::vector<std::string> arguments = ArgumentsWith(OwnArguments(), flags);
  std::vector<char*> words;
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  LeaveOpenOnlyHeld();  // the library opens sockets that outlive an exec
  execv("/proc/self/exe", words.data());
  ThrowErrno("cannot restart itself");
}

std::string HoldText(const std::string& name, const std::string& text) {
  return PathOf(MakeHeld(name, text));
}

bool HoldTextFor(const std::string& flag, const std::string& name, const std::string& text,
                 NewFlags* flags) {
  try {
    (*flags)[flag] = HoldText(name, text);
    return true;
  } catch (const std::system_error& error) {
    LogWarning("restarts itself without a new " + flag + ": " + error.what());
    return false;
  }
}

HeldText::HeldText(const std::string& name, const std::string& text)
    : descriptor_(MakeHeld(name, text)) {}

HeldText::~HeldText() { close(descriptor_); }

std::string HeldText::Path() const { return PathOf(descriptor_); }

std::string NameOf(const std::string& path) {
  namespace fs = std::filesystem;
  if (HeldDescriptor(path) < 0) return fs::path(path).filename();
  // The kernel shows it as "/memfd:NAME (deleted)".
  constexpr std::string_view kBefore = "memfd:";
  constexpr std::string_view kAfter = " (deleted)";
  std::error_code error;
  std::string name = fs::read_symlink(path, error).filename();
  if (name.starts_with(kBefore)) name.erase(0, kBefore.size());
  if (name.ends_with(kAfter)) name.erase(name.size() - kAfter.size());
  return name;
}

void LetGo(const std::string& path) {
  const int descriptor = HeldDescriptor(path);
  if (descriptor >= 0) fcntl(descriptor, F_SETFD, FD_CLOEXEC);
}

void HoldAgain(const std::string& path) {
  const int descriptor = HeldDescriptor(path);
  if (descriptor >= 0) fcntl(descriptor, F_SETFD, 0);
}

}  // namespace giveway
