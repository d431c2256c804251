#include <sys/random.h>

#include <cerrno>
#include <ctime>

#include "services/runtime/process.h"
#include "services/types/check.h"

namespace giveway {

namespace {

Nanoseconds Read(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::chrono::seconds{now.tv_sec} + std::chrono::nanoseconds{now.tv_nsec};
}

}  // namespace

SteadyTime SteadyNow() { return Read(CLOCK_MONOTONIC); }

Nanoseconds ThreadTimeNow() { return Read(CLOCK_THREAD_CPUTIME_ID); }

void SleepUntil(SteadyTime when) {
  const auto seconds = std::chrono::floor<std::chrono::seconds>(when);
  timespec deadline{};
  deadline.tv_sec = static_cast<time_t>(seconds.count());
  deadline.tv_nsec = static_cast<long>((when - seconds).count());
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, nullptr) == EINTR) {
  }
}

std::uint32_t RandomNonZero() {
  std::uint32_t number = 0;
  while (number == 0) {
    const ssize_t got = getrandom(&number, sizeof(number), 0);
    GIVEWAY_CHECK(got == sizeof(number) || errno == EINTR, got, errno);
    if (got != sizeof(number)) number = 0;
  }
  return number;
}

NextTick AfterDeadline(SteadyTime deadline, Nanoseconds period, SteadyTime now) {
  const auto missed = now > deadline ? (now - deadline) / period : 0;
  return {deadline + (missed + 1) * period, static_cast<std::uint32_t>(missed)};
}

Ticker::Ticker(Nanoseconds period) : period_(period), next_(SteadyNow() + period) {
  GIVEWAY_CHECK(period.count() > 0, period.count());
}

std::uint32_t Ticker::Wait() {
  const NextTick next = AfterDeadline(next_, period_, SteadyNow());
  SleepUntil(next_);  // returns at once when late
  next_ = next.deadline;
  return next.missed;
}

}  // namespace giveway
