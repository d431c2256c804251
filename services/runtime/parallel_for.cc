#include "services/runtime/parallel_for.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <system_error>
#include <thread>
#include <vector>

namespace giveway {
namespace {

// More pieces than threads: a delayed thread does fewer.
constexpr std::size_t kPiecesEach = 4;
// Some tens of microseconds: what waking a sleeper costs (30 us), and within a tick the next call
// comes sooner.
constexpr int kSpins = 1000;

void Pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

// Waits until `value` is no longer `old`: spins for a moment, then sleeps.
template <typename T>
T AwaitChange(const std::atomic<T>& value, T old) {
  for (int i = 0; i < kSpins; ++i) {
    const T now = value.load(std::memory_order_acquire);
    if (now != old) return now;
    Pause();
  }
  value.wait(old, std::memory_order_acquire);
  return value.load(std::memory_order_acquire);
}

}  // namespace

class ParallelPool::Workers {
 public:
  explicit Workers(unsigned count) {
    threads_.reserve(count);
    try {
      while (threads_.size() < count) threads_.emplace_back([this] { Work(); });
    } catch (const std::system_error&) {
      // Who calls Run works too: with fewer, or none, it takes longer, and the results are the
      // same.
    }
  }
  ~Workers() {
    stop_.store(true, std::memory_order_relaxed);
    Wake();
    for (std::thread& thread : threads_) thread.join();
  }
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  void Run(std::size_t count, const ParallelBody& body) {
    if (count == 0) return;
    if (count == 1 || busy_.exchange(true, std::memory_order_acquire)) {
      body(0, count);
      return;
    }
    const std::size_t pieces = std::min(count, (threads_.size() + 1) * kPiecesEach);
    body_ = &body;
    count_ = count;
    pieces_ = pieces;
    unfinished_.store(static_cast<std::uint32_t>(pieces), std::memory_order_relaxed);
    // A thread that takes a piece sees what was written above.
    unclaimed_.store(static_cast<std::uint32_t>(pieces), std::memory_order_release);
    Wake();
    RunPieces();
    AwaitFinish();
    busy_.store(false, std::memory_order_release);
  }

 private:
  void Wake() {
    calls_.fetch_add(1, std::memory_order_release);
    calls_.notify_all();
  }

  void Work() {
    std::uint32_t seen = 0;
    while (!stop_.load(std::memory_order_relaxed)) {
      RunPieces();
      seen = AwaitChange(calls_, seen);
    }
  }

  // A piece once taken keeps its call from ending, so what describes the call stands still until
  // the piece is done. A worker that comes late finds nothing to take, or pieces of the next call.
  void RunPieces() {
    std::uint32_t left = unclaimed_.load(std::memory_order_relaxed);
    while (left > 0) {
      if (!unclaimed_.compare_exchange_weak(left, left - 1, std::memory_order_acq_rel,
                                            std::memory_order_relaxed)) {
        continue;
      }
      RunPiece(left - 1);
      if (unfinished_.fetch_sub(1, std::memory_order_acq_rel) == 1) unfinished_.notify_one();
      left = unclaimed_.load(std::memory_order_relaxed);
    }
  }

  void RunPiece(std::size_t piece) const {
    const std::size_t size = count_ / pieces_;
    const std::size_t longer = count_ % pieces_;  // so many pieces are longer by one
    const std::size_t begin = piece * size + std::min(piece, longer);
    (*body_)(begin, begin + size + (piece < longer ? 1 : 0));
  }

  void AwaitFinish() {
    std::uint32_t left = unfinished_.load(std::memory_order_acquire);
    while (left > 0) left = AwaitChange(unfinished_, left);
  }

  // Of the current call.
  const ParallelBody* body_ = nullptr;
  std::size_t count_ = 0;
  std::size_t pieces_ = 0;

  // Apart in memory, for each is written by threads that do not need the others.
  alignas(64) std::atomic<std::uint32_t> unclaimed_{0};
  alignas(64) std::atomic<std::uint32_t> unfinished_{0};
  alignas(64) std::atomic<std::uint32_t> calls_{0};
  alignas(64) std::atomic<bool> busy_{false};
  std::atomic<bool> stop_{false};
  std::vector<std::thread> threads_;  // last: they use all of the above
};

ParallelPool::ParallelPool(unsigned threads)
    : workers_(threads > 1 ? std::make_unique<Workers>(threads - 1) : nullptr) {}

ParallelPool::~ParallelPool() = default;

ParallelFor ParallelPool::Function() {
  if (workers_ == nullptr) return OnThisThread;
  return [workers = workers_.get()](std::size_t count, const ParallelBody& body) {
    workers->Run(count, body);
  };
}

}  // namespace giveway
