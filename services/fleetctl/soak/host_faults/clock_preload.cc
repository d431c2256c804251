// The library that a soak preloads into processes whose system clock it steps: readings of
// CLOCK_REALTIME are shifted by the offset in a file that the soak maps too, and waits until a time
// of it are shifted back, since the kernel's clock is unchanged: those of conditions, and those of
// mutexes and semaphores, by which Fast DDS waits in shared memory. Monotonic clocks are unchanged,
// as in a real step. libfaketime does the same for whole programs, but makes a vehicle
// with Fast DDS 2.9.1 hang: it takes every timed wait for one on the system clock.
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>

#include "services/fleetctl/soak/host_faults/clock_shift.h"

namespace giveway::fleetctl {
namespace {

// A wait until a later time than this is on the system clock: no machine has been up that long.
constexpr std::time_t kOfSystemClock_s = 1'000'000'000;

ClockShift* MapShift() {
  static ClockShift none;
  const char* const path = std::getenv(kClockShiftVariable);
  if (path == nullptr) return &none;
  const int file = ::open(path, O_RDWR | O_CLOEXEC);
  if (file < 0) return &none;
  void* const mapped =
      ::mmap(nullptr, sizeof(ClockShift), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  ::close(file);
  return mapped == MAP_FAILED ? &none : static_cast<ClockShift*>(mapped);
}

ClockShift& Shift() {
  static ClockShift* const shift = MapShift();
  return *shift;
}

template <typename Function>
Function* Original(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

// The same moment on the kernel's clock.
timespec OnKernelClock(const timespec& until) {
  timespec moved = until;
  if (moved.tv_sec > kOfSystemClock_s) moved.tv_sec -= Shift().offset_s;
  return moved;
}

timespec ReadSystemClock() {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return now;
}

}  // namespace
}  // namespace giveway::fleetctl

extern "C" {

int clock_gettime(clockid_t clock, timespec* now) noexcept {
  static auto* const original =
      giveway::fleetctl::Original<int(clockid_t, timespec*)>("clock_gettime");
  const int code = original(clock, now);
  if (code != 0 || (clock != CLOCK_REALTIME && clock != CLOCK_REALTIME_COARSE)) return code;
  giveway::fleetctl::ClockShift& shift = giveway::fleetctl::Shift();
  if (const std::int64_t offset_s = shift.offset_s; offset_s != 0) {
    now->tv_sec += offset_s;
    ++shift.shifted;
  }
  return code;
}

int gettimeofday(timeval* now, void* /*zone*/) noexcept {
  const timespec read = giveway::fleetctl::ReadSystemClock();
  *now = {read.tv_sec, read.tv_nsec / 1000};
  return 0;
}

std::time_t time(std::time_t* now) noexcept {
  const std::time_t read_s = giveway::fleetctl::ReadSystemClock().tv_sec;
  if (now != nullptr) *now = read_s;
  return read_s;
}

int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex,
                           const timespec* until) {
  static auto* const original =
      giveway::fleetctl::Original<int(pthread_cond_t*, pthread_mutex_t*, const timespec*)>(
          "pthread_cond_timedwait");
  const timespec moved = giveway::fleetctl::OnKernelClock(*until);
  return original(condition, mutex, &moved);
}

int pthread_mutex_timedlock(pthread_mutex_t* mutex, const timespec* until) noexcept {
  static auto* const original = giveway::fleetctl::Original<int(pthread_mutex_t*, const timespec*)>(
      "pthread_mutex_timedlock");
  const timespec moved = giveway::fleetctl::OnKernelClock(*until);
  return original(mutex, &moved);
}

int sem_timedwait(sem_t* semaphore, const timespec* until) {
  static auto* const original =
      giveway::fleetctl::Original<int(sem_t*, const timespec*)>("sem_timedwait");
  const timespec moved = giveway::fleetctl::OnKernelClock(*until);
  return original(semaphore, &moved);
}

}  // extern "C"
