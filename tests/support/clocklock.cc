// Makes the thread sanitizer see the locks of Fast DDS. The library locks its timed mutexes by
// pthread_mutex_clocklock, which libtsan of g++ 12 does not intercept: every access under such a
// mutex looked like a race, in whatever function touched the memory last. This one, which the
// linker puts before libc's, waits by pthread_mutex_timedlock, which libtsan intercepts. Linked
// into the programs of the thread sanitizer's tree alone.
#include <pthread.h>

#include <cerrno>
#include <cstdint>
#include <ctime>

namespace {

constexpr std::int64_t kNanoseconds = 1'000'000'000;

std::int64_t InNanoseconds(const timespec& time) {
  return static_cast<std::int64_t>(time.tv_sec) * kNanoseconds + time.tv_nsec;
}

}  // namespace

// As in pthread_mutex_clocklock(3), but that a step of the realtime clock in the middle of the wait
// moves its end.
extern "C" int pthread_mutex_clocklock(pthread_mutex_t* mutex, clockid_t clock,
                                       const timespec* until) noexcept {
  timespec now{};
  timespec realtime{};
  if (clock_gettime(clock, &now) != 0 || clock_gettime(CLOCK_REALTIME, &realtime) != 0) {
    return EINVAL;
  }
  const std::int64_t end = InNanoseconds(realtime) + InNanoseconds(*until) - InNanoseconds(now);
  const timespec end_realtime{.tv_sec = static_cast<std::time_t>(end / kNanoseconds),
                              .tv_nsec = static_cast<long>(end % kNanoseconds)};
  return pthread_mutex_timedlock(mutex, &end_realtime);
}
