// The newest value of one writer for any number of readers: a sequence lock. The writer never
// waits, whatever the readers do; a reader that overlapped a write reads again. The words are
// atomics, so that a torn copy is thrown away and never a data race: a reader that acquired one
// word of a write also sees that the write had started.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <thread>
#include <type_traits>

namespace giveway {

template <typename Value>
class HealthBoard {
 public:
  static_assert(std::is_trivially_copyable_v<Value>);

  HealthBoard() { Publish(Value{}); }
  HealthBoard(const HealthBoard&) = delete;
  HealthBoard& operator=(const HealthBoard&) = delete;

  // One thread's, always the same.
  void Publish(const Value& value) {
    Words words{};
    std::memcpy(words.data(), &value, sizeof(Value));
    const std::uint64_t turn = turn_.load(std::memory_order_relaxed);
    turn_.store(turn + 1, std::memory_order_relaxed);  // odd: being written
    for (std::size_t i = 0; i < kWords; ++i) words_[i].store(words[i], std::memory_order_release);
    turn_.store(turn + 2, std::memory_order_release);
  }

  Value Read() const {
    for (;; std::this_thread::yield()) {
      const std::uint64_t before = turn_.load(std::memory_order_acquire);
      if (before % 2 != 0) continue;
      Words words{};
      for (std::size_t i = 0; i < kWords; ++i) words[i] = words_[i].load(std::memory_order_acquire);
      if (turn_.load(std::memory_order_relaxed) != before) continue;
      Value value;
      std::memcpy(static_cast<void*>(&value), words.data(), sizeof(Value));
      return value;
    }
  }

 private:
  static constexpr std::size_t kWords = (sizeof(Value) + 7) / 8;
  using Words = std::array<std::uint64_t, kWords>;
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

  std::atomic<std::uint64_t> turn_{0};
  std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

}  // namespace giveway
