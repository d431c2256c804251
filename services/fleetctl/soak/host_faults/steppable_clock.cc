#include "services/fleetctl/soak/host_faults/steppable_clock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <new>
#include <utility>

#include "services/fleetctl/process/child_process.h"
#include "services/fleetctl/process/file_descriptor.h"

namespace giveway::fleetctl {
namespace {

constexpr mode_t kOwnerOnly = 0600;

void* MapNew(const std::string& file) {
  const FileDescriptor made(
      ::open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, kOwnerOnly));
  if (!made.IsOpen()) return MAP_FAILED;
  // Zeros, not a hole: on a full disk a write through the mapping would end this process.
  constexpr std::array<char, sizeof(ClockShift)> kZeros{};
  errno = ENOSPC;  // of a part
  if (::write(made.Get(), kZeros.data(), kZeros.size()) != std::ssize(kZeros)) return MAP_FAILED;
  return ::mmap(nullptr, sizeof(ClockShift), PROT_READ | PROT_WRITE, MAP_SHARED, made.Get(), 0);
}

}  // namespace

std::filesystem::path ClockStepLibrary() {
  const auto library =
      ProgramFolder().parent_path() / "lib" / "giveway" / "libgiveway-clock-step.so";
  std::error_code missing;
  return std::filesystem::exists(library, missing) ? library : std::filesystem::path();
}

SteppableClock::SteppableClock(const std::filesystem::path& file)
    : file_(std::filesystem::absolute(file).string()) {
  void* const mapped = MapNew(file_);
  if (mapped == MAP_FAILED) {
    throw StartError(fmt::format("cannot make {}: {}", file_, std::strerror(errno)));
  }
  shift_ = new (mapped) ClockShift;
}

SteppableClock::~SteppableClock() {
  if (shift_ != nullptr) ::munmap(shift_, sizeof(ClockShift));
}

SteppableClock::SteppableClock(SteppableClock&& other) noexcept
    : file_(std::move(other.file_)), shift_(std::exchange(other.shift_, nullptr)) {}

std::vector<std::string> SteppableClock::Environment() const {
  return {"LD_PRELOAD=" + ClockStepLibrary().string(),
          fmt::format("{}={}", kClockShiftVariable, file_)};
}

}  // namespace giveway::fleetctl
