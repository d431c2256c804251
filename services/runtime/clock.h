// The clocks as a value, for what is to be tested without waiting.
#pragma once

#include "services/runtime/process.h"
#include "services/types/time.h"

namespace giveway {

class Clock {
 public:
  virtual SteadyTime Now() const = 0;
  virtual void SleepUntil(SteadyTime when) = 0;
  // Processor time that this thread has used: what a busy machine keeps it waiting is not in it.
  virtual Nanoseconds ThreadTime() const = 0;

 protected:
  ~Clock() = default;
};

class SteadyClock final : public Clock {
 public:
  SteadyTime Now() const override { return SteadyNow(); }
  void SleepUntil(SteadyTime when) override { giveway::SleepUntil(when); }
  Nanoseconds ThreadTime() const override { return ThreadTimeNow(); }
};

}  // namespace giveway
