// A log whose reader has stopped: a thread that logs never waits, and what is dropped is counted
// and reported.
#include "services/runtime/log_queue.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <memory>
#include <string>

namespace giveway {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr Nanoseconds kLong = std::chrono::seconds(10);
constexpr std::size_t kMostWaiting = 1000;

std::string Dropped(std::uint64_t count) { return "<" + std::to_string(count) + " dropped>\n"; }

// A log into a pipe that is full until it is read.
class StoppedReader : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(::pipe(ends_.data()), 0);
    ::fcntl(ends_[1], F_SETFL, O_NONBLOCK);
    const std::string filling(4096, '.');
    while (::write(ends_[1], filling.data(), filling.size()) > 0) {
    }
    ::fcntl(ends_[1], F_SETFL, 0);
    queue_ = std::make_unique<LogQueue>(ends_[1], kMostWaiting);
    queue_->SetNotice(Dropped);
  }
  void TearDown() override {
    if (ends_[0] >= 0) Read();
    queue_.reset();
    ::close(ends_[1]);
  }
  // What was written after the filler, once nothing waits any more.
  std::string Read() {
    ::fcntl(ends_[0], F_SETFL, O_NONBLOCK);
    std::string text;
    std::array<char, 4096> part{};
    for (bool all = false; !all;) {
      all = queue_->Flush(Nanoseconds{0});
      for (ssize_t got = 0; (got = ::read(ends_[0], part.data(), part.size())) > 0;) {
        text.append(part.data(), static_cast<std::size_t>(got));
      }
    }
    ::close(ends_[0]);
    ends_[0] = -1;
    return text.substr(std::min(text.size(), text.find_first_not_of('.')));
  }

  std::array<int, 2> ends_{};
  std::unique_ptr<LogQueue> queue_;
};

TEST_F(StoppedReader, HoldsUpNeitherWhoLogsNorTheEnd) {
  for (int i = 0; i < 100000; ++i) queue_->Push("a line of the log\n");
  EXPECT_FALSE(queue_->Flush(Nanoseconds{0}));
  EXPECT_GT(queue_->Dropped(), 99000U);
}

TEST_F(StoppedReader, IsToldHowMuchItMissedOnceItReadsAgain) {
  for (int i = 0; i < 1000; ++i) queue_->Push("an early line\n");
  const std::uint64_t dropped = queue_->Dropped();
  const std::string text = Read();
  EXPECT_THAT(text, StartsWith("an early line\n"));
  EXPECT_THAT(text, HasSubstr(Dropped(dropped)));
  EXPECT_EQ(text.find("dropped"), text.rfind("dropped"));
}

TEST(LogQueue, WritesEveryLineInOrderWhereItIsRead) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  std::string pushed;
  {
    LogQueue queue(ends[1], 1U << 20U);
    for (int i = 0; i < 1000; ++i) {
      pushed += std::to_string(i) + "\n";
      queue.Push(std::to_string(i) + "\n");
    }
    EXPECT_TRUE(queue.Flush(kLong));
    EXPECT_EQ(queue.Dropped(), 0U);
  }
  ::close(ends[1]);
  std::string text(2 * pushed.size(), ' ');
  text.resize(static_cast<std::size_t>(::read(ends[0], text.data(), text.size())));
  EXPECT_EQ(text, pushed);
  ::close(ends[0]);
}

// A log on a full disk: nothing can be reported there, and the thread must not try for ever.
TEST(LogQueue, ADescriptorThatRefusesEveryLineIsCounted) {
  const int full = ::open("/dev/full", O_WRONLY);
  ASSERT_GE(full, 0);
  LogQueue queue(full, kMostWaiting);
  queue.SetNotice(Dropped);
  for (int i = 0; i < 3; ++i) {
    queue.Push("a line\n");
    EXPECT_TRUE(queue.Flush(kLong));
  }
  EXPECT_EQ(queue.Dropped(), 3U);
}

}  // namespace
}  // namespace giveway
