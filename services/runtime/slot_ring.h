// A bounded queue between one thread that must not wait and one that may. The first fills slots in
// place, the second empties them in order; slots are used again, with whatever memory they hold.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

namespace giveway {

template <typename Slot>
class SlotRing {
 public:
  explicit SlotRing(std::size_t slots) : slots_(slots) {}

  // The filling thread's: a slot to fill, or null if all are full; then Push what was filled.
  Slot* Free() {
    const std::uint32_t filled = filled_.load(std::memory_order_relaxed);
    if (filled - emptied_.load(std::memory_order_acquire) == slots_.size()) return nullptr;
    return &slots_[filled % slots_.size()];
  }
  void Push() {
    filled_.fetch_add(1, std::memory_order_release);
    Wake();
  }
  // Nothing more will be pushed.
  void Close() {
    closed_.store(true, std::memory_order_release);
    Wake();
  }

  // The emptying thread's: waits for a slot; null once the ring is closed and empty. Then Pop it.
  Slot* Next() {
    for (;;) {
      const std::uint32_t calls = calls_.load(std::memory_order_acquire);
      const std::uint32_t emptied = emptied_.load(std::memory_order_relaxed);
      const bool closed = closed_.load(std::memory_order_acquire);
      if (filled_.load(std::memory_order_acquire) != emptied) {
        return &slots_[emptied % slots_.size()];
      }
      if (closed) return nullptr;
      calls_.wait(calls, std::memory_order_acquire);
    }
  }
  void Pop() { emptied_.fetch_add(1, std::memory_order_release); }

 private:
  void Wake() {
    calls_.fetch_add(1, std::memory_order_release);
    calls_.notify_one();
  }

  std::vector<Slot> slots_;
  // Counts of all time; they wrap, and only differences are used: slots must be a power of two.
  std::atomic<std::uint32_t> filled_{0};
  std::atomic<std::uint32_t> emptied_{0};
  std::atomic<std::uint32_t> calls_{0};
  std::atomic<bool> closed_{false};
};

}  // namespace giveway
