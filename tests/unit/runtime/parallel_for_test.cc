// The thread pool: every index once, whatever the count, the threads, and the other callers.
#include "services/runtime/parallel_for.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <set>
#include <thread>
#include <vector>

#include "services/types/sanitizers.h"

namespace giveway {
namespace {

// How often each index was given out. Plain bytes: two threads on one index are a data race, which
// the thread sanitizer reports.
std::vector<std::uint8_t> Visits(const ParallelFor& parallel_for, std::size_t count) {
  std::vector<std::uint8_t> visits(count, 0);
  parallel_for(count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) ++visits[i];
  });
  return visits;
}

bool EachOnce(const std::vector<std::uint8_t>& visits) {
  return std::all_of(visits.begin(), visits.end(), [](std::uint8_t n) { return n == 1; });
}

// Leaves this process address space for the stacks of so many threads, and half of one more.
void AllowThreads(rlim_t threads) {
  pthread_attr_t attributes;
  std::size_t stack_bytes = 0;
  pthread_attr_init(&attributes);
  pthread_attr_getstacksize(&attributes, &stack_bytes);
  pthread_attr_destroy(&attributes);
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const auto page_bytes = static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
  const rlim_t most = pages * page_bytes + threads * stack_bytes + stack_bytes / 2;
  const rlimit limit{most, most};
  ::setrlimit(RLIMIT_AS, &limit);
}

// Regression: where the second of several threads could not be started, the world was aborted.
TEST(ParallelPool, WorksWithAsManyThreadsAsCanBeStarted) {
#if defined(GIVEWAY_ADDRESS_SANITIZER) || defined(GIVEWAY_THREAD_SANITIZER)
  GTEST_SKIP() << "a sanitizer needs its own address space";
#endif
  for (const rlim_t threads : {0U, 1U, 3U}) {
    EXPECT_EXIT(
        {
          AllowThreads(threads);
          ParallelPool pool(8);
          std::exit(EachOnce(Visits(pool.Function(), 1000)) ? 0 : 1);
        },
        ::testing::ExitedWithCode(0), "");
  }
}

class ParallelPoolOf : public ::testing::TestWithParam<unsigned> {};

TEST_P(ParallelPoolOf, VisitsEachIndexOnceWhateverTheCount) {
  ParallelPool pool(GetParam());
  const ParallelFor parallel_for = pool.Function();
  for (std::size_t count = 0; count < 200; ++count) {
    EXPECT_TRUE(EachOnce(Visits(parallel_for, count))) << count;
  }
  for (const std::size_t count : {1000U, 4096U, 65537U}) {
    EXPECT_TRUE(EachOnce(Visits(parallel_for, count))) << count;
  }
}

// Calls in quick succession: a worker that is late for one meets the next.
TEST_P(ParallelPoolOf, KeepsItsCallsApart) {
  ParallelPool pool(GetParam());
  const ParallelFor parallel_for = pool.Function();
  for (std::size_t call = 0; call < 20'000; ++call) {
    std::array<std::size_t, 9> seen{};
    const std::size_t count = 1 + call % seen.size();
    parallel_for(count, [&seen, call](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) seen[i] += call + 1;
    });
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(seen[i], call + 1);
  }
}

TEST_P(ParallelPoolOf, GivesOutNoEmptyPiece) {
  ParallelPool pool(GetParam());
  std::atomic<int> empty{0};
  for (std::size_t count = 0; count < 50; ++count) {
    pool.Function()(count, [&](std::size_t begin, std::size_t end) { empty += begin >= end; });
  }
  EXPECT_EQ(empty, 0);
}

TEST_P(ParallelPoolOf, RunsACallFromInsideABodyInOnePiece) {
  ParallelPool pool(GetParam());
  const ParallelFor parallel_for = pool.Function();
  std::vector<std::vector<std::uint8_t>> visits(64);
  parallel_for(visits.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) visits[i] = Visits(parallel_for, i + 2);
  });
  for (const auto& inner : visits) EXPECT_TRUE(EachOnce(inner));
}

TEST_P(ParallelPoolOf, ServesTwoCallersAtOnce) {
  ParallelPool pool(GetParam());
  const ParallelFor parallel_for = pool.Function();
  std::atomic<int> wrong{0};
  const auto call = [&] {
    for (int i = 0; i < 500; ++i) wrong += !EachOnce(Visits(parallel_for, 300));
  };
  std::thread other(call);
  call();
  other.join();
  EXPECT_EQ(wrong, 0);
}

TEST_P(ParallelPoolOf, EndsUnusedToo) {
  for (int i = 0; i < 100; ++i) ParallelPool pool(GetParam());
}

// Called from within a body, which then continues: the pool serves the next call as before.
TEST_P(ParallelPoolOf, IsFreeAgainAfterEachCall) {
  ParallelPool pool(GetParam());
  const ParallelFor parallel_for = pool.Function();
  const auto pieces = [&] {
    std::atomic<int> count{0};
    parallel_for(1000, [&](std::size_t, std::size_t) { ++count; });
    return count.load();
  };
  const int first = pieces();
  parallel_for(8, [&](std::size_t, std::size_t) { parallel_for(8, [](auto, auto) {}); });
  EXPECT_EQ(pieces(), first);
  EXPECT_GE(first, static_cast<int>(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Threads, ParallelPoolOf, ::testing::Values(0U, 1U, 2U, 3U, 8U),
                         ::testing::PrintToStringParamName());

// Every body waits for the other: this ends only with two threads at the same time.
TEST(ParallelPool, TheCallerAndTheWorkersWorkTogether) {
  ParallelPool pool(2);
  std::atomic<int> here{0};
  std::array<std::thread::id, 2> threads;
  std::atomic<bool> done{false};
  pool.Function()(2, [&](std::size_t begin, std::size_t) {
    threads[begin] = std::this_thread::get_id();
    ++here;
    while (here < 2 && !done) std::this_thread::yield();
    done = true;
  });
  EXPECT_NE(threads[0], threads[1]);
  EXPECT_TRUE(std::count(threads.begin(), threads.end(), std::this_thread::get_id()) == 1);
}

TEST(ParallelPool, OneThreadIsTheCallers) {
  ParallelPool pool(1);
  std::set<std::thread::id> threads;
  int pieces = 0;
  pool.Function()(1000, [&](std::size_t begin, std::size_t end) {
    threads.insert(std::this_thread::get_id());
    ++pieces;
    EXPECT_EQ(begin, 0U);
    EXPECT_EQ(end, 1000U);
  });
  EXPECT_EQ(threads, std::set{std::this_thread::get_id()});
  EXPECT_EQ(pieces, 1);
}

}  // namespace
}  // namespace giveway
