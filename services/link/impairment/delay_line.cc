#include "services/link/impairment/delay_line.h"

#include <cstdint>
#include <utility>

namespace giveway::link {
namespace {

// Two seconds of a full fleet's traffic at 20 Hz.
constexpr std::size_t kMostUnderWay = 16384;

}  // namespace

void LatePacket::HandOn() const {
  receiver->OnDataReceived(bytes.data(), static_cast<std::uint32_t>(bytes.size()), local, remote);
}

DelayLine::DelayLine() : thread_([this] { Run(); }) {}

DelayLine::~DelayLine() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
  }
  woken_.notify_one();
  thread_.join();
}

bool DelayLine::Push(Time due, LatePacket packet) {
  {
    const std::scoped_lock lock(mutex_);
    if (waiting_.size() >= kMostUnderWay) return false;
    const auto at = waiting_.emplace(due, std::move(packet));
    if (at != waiting_.begin()) return true;  // the thread sleeps until an earlier one is due
  }
  woken_.notify_one();
  return true;
}

std::size_t DelayLine::Forget(std::uint32_t local_port) {
  std::unique_lock lock(mutex_);
  const std::size_t lost = std::erase_if(
      waiting_, [local_port](const auto& entry) { return entry.second.local.port == local_port; });
  idle_.wait(lock, [this] { return !handing_on_; });
  return lost;
}

void DelayLine::Run() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    if (waiting_.empty()) {
      woken_.wait(lock);
      continue;
    }
    const Time due = waiting_.begin()->first;
    if (std::chrono::steady_clock::now() < due) {
      woken_.wait_until(lock, due);
      continue;
    }
    const LatePacket packet = std::move(waiting_.extract(waiting_.begin()).mapped());
    handing_on_ = true;
    lock.unlock();  // the library may take as long as it likes
    packet.HandOn();
    lock.lock();
    handing_on_ = false;
    idle_.notify_all();
  }
}

}  // namespace giveway::link
