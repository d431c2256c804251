// How far forged packets can move a writer's numbers, and which numbers of honest writers pass: at
// many rates, in bursts, through losses and blackouts.
#include "services/link/packet_filter/writer_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <random>

namespace giveway::link {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr SteadyTime kMeeting = seconds(1000);
constexpr Nanoseconds kForgersPeriod = std::chrono::microseconds(500);

WriterGuid Guid(std::uint32_t number) {
  return {static_cast<std::uint8_t>(number), static_cast<std::uint8_t>(number >> 8U),
          static_cast<std::uint8_t>(number >> 16U), 5};
}

Nanoseconds PeriodOf(double rate_hz) { return FromSeconds(1 / rate_hz); }

// One writer as one receiver hears it.
class OneWriter {
 public:
  explicit OneWriter(bool of_all_bodies = false) : table_(64, 4711, 0, of_all_bodies) {}
  bool Sample(std::int64_t number) {
    const bool passed = table_.IsPlausible(Guid(1), number, Statement::kSample, now_);
    if (passed) believed_ = std::max(believed_, number);
    return passed;
  }
  bool Range(std::int64_t last) {
    return table_.IsPlausible(Guid(1), last, Statement::kRange, now_);
  }
  // What comes every period, with nothing lost.
  void Send(std::int64_t samples, double rate_hz) {
    for (std::int64_t i = 0; i < samples; ++i) {
      ASSERT_TRUE(Sample(++sent_)) << sent_ << " of " << rate_hz << " Hz";
      now_ += PeriodOf(rate_hz);
    }
  }
  void Lose(std::int64_t samples, double rate_hz) {
    sent_ += samples;
    now_ += samples * PeriodOf(rate_hz);
  }
  void Wait(Nanoseconds time) { now_ += time; }

  std::int64_t Sent() const { return sent_; }
  std::int64_t Next() { return ++sent_; }
  // How many of its next samples a reader would skip.
  std::int64_t Lead() const { return std::max<std::int64_t>(believed_ - sent_, 0); }
  SteadyTime Now() const { return now_; }

 private:
  WriterTable table_;
  SteadyTime now_ = kMeeting;
  std::int64_t sent_ = 100;
  std::int64_t believed_ = 0;
};

TEST(WriterTable, PassesHonestWritersOfAnyRate) {
  for (const double rate_hz : {0.5, 5.0, 20.0, 60.0, 200.0, 1000.0}) {
    OneWriter writer;
    writer.Send(static_cast<std::int64_t>(20 * rate_hz) + 5, rate_hz);
  }
}

TEST(WriterTable, PassesAWriterThatBecomesFaster) {
  OneWriter writer;
  writer.Send(300, 5);  // before the start
  writer.Send(600, 20);
  writer.Send(4000, 200);
}

// Regression: at 500 Hz and 20 % loss half of a vehicle's beacons were dropped: steps of one used
// up the budget that larger ones need.
TEST(WriterTable, PassesAFastWriterWithLossFromItsFirstSecondOn) {
  OneWriter writer;
  for (int turn = 0; turn < 500; ++turn) {
    writer.Send(4, 500);
    writer.Lose(1, 500);
  }
}

// With every vehicle that joins there are more poses of bodies.
TEST(WriterTable, PassesToAnObserverAFleetThatGrows) {
  OneWriter writer(true);
  writer.Send(100, 20);
  for (int bodies = 1; bodies <= 200; bodies += 20) {
    for (int body = 0; body < bodies; ++body) ASSERT_TRUE(writer.Sample(writer.Next())) << bodies;
    writer.Wait(milliseconds(50));
  }
}

// The world's writer of all poses: a burst every tick.
TEST(WriterTable, PassesBursts) {
  for (const int bodies : {2, 30, 200, 500}) {
    OneWriter writer;
    for (int tick = 0; tick < 200; ++tick) {
      for (int body = 0; body < bodies; ++body) {
        ASSERT_TRUE(writer.Sample(writer.Next())) << bodies << " in tick " << tick;
      }
      writer.Wait(milliseconds(50));
    }
  }
}

TEST(WriterTable, PassesBurstsOfEventsOfAReliableWriter) {
  OneWriter writer;
  ASSERT_TRUE(writer.Range(writer.Sent()));
  for (int second = 0; second < 30; ++second) {
    for (int i = 0; i < (second % 10 == 9 ? 200 : 1); ++i) {
      ASSERT_TRUE(writer.Sample(writer.Next())) << second;
      ASSERT_TRUE(writer.Range(writer.Sent())) << second;
    }
    writer.Wait(seconds(1));
  }
}

// Nine in ten lost, for minutes, and some late.
TEST(WriterTable, PassesWhatHeavyLossLeaves) {
  for (const double rate_hz : {20.0, 200.0}) {
    for (const double lost : {0.1, 0.5, 0.9}) {
      std::mt19937_64 random(7);
      std::bernoulli_distribution is_lost(lost);
      std::uniform_int_distribution<int> late(0, 4);
      OneWriter writer;
      for (int i = 0; i < 4000; ++i) {
        const std::int64_t number = writer.Next();
        const std::int64_t behind = late(random) == 0 ? late(random) : 0;
        if (!is_lost(random)) {
          ASSERT_TRUE(writer.Sample(std::max<std::int64_t>(number - behind, 1)))
              << number << " at " << rate_hz << " Hz, lost " << lost;
        }
        writer.Wait(PeriodOf(rate_hz));
      }
    }
  }
}

// A radio storm, a second of impairment, a cable unplugged for a minute.
TEST(WriterTable, PassesWhatFollowsABlackout) {
  for (const double rate_hz : {1.0, 20.0, 200.0}) {
    for (const int silent_s : {1, 3, 10, 60, 600}) {
      OneWriter writer;
      writer.Send(static_cast<std::int64_t>(3 * rate_hz), rate_hz);
      for (int round = 0; round < 5; ++round) {
        writer.Lose(static_cast<std::int64_t>(silent_s * rate_hz), rate_hz);
        writer.Send(static_cast<std::int64_t>(2 * rate_hz), rate_hz);
      }
    }
  }
}

TEST(WriterTable, PassesABlackoutInTheFirstSecondToo) {
  OneWriter writer;
  writer.Send(2, 20);
  writer.Lose(60 * 20, 20);
  writer.Send(100, 20);
}

// Regression: the step was a share of a pace that each forged number raised, by half with every
// packet.
TEST(WriterTable, NoFloodOfStepsIsFasterThanTheBudget) {
  for (const std::int64_t step : {1, 8, 64}) {
    OneWriter writer;
    writer.Send(600, 20);
    const std::int64_t from = writer.Sent();
    std::int64_t highest = from;
    double rate_hz = SequenceBudget::kLeastRate_hz;
    double most = 64;
    for (int second = 0; second < 20; ++second) {  // the true writer is silent
      most += rate_hz;
      for (int packet = 0; packet < 2000; ++packet) {
        if (writer.Sample(highest + step)) highest += step;
        writer.Wait(kForgersPeriod);
      }
      ASSERT_LE(static_cast<double>(highest - from), most) << "step " << step << ", s " << second;
      rate_hz = std::min(2 * (rate_hz + 64), SequenceBudget::kHighestRate_hz);
    }
  }
}

// Issue 25: a scan 66 numbers ahead, and the vehicle heard nothing of its world for 3.3 s.
TEST(WriterTable, AForgedSampleBlindsForASecondAtMost) {
  OneWriter writer;
  writer.Send(60, 20);
  for (std::int64_t ahead = 500; ahead > 0; --ahead) writer.Sample(writer.Sent() + ahead);
  EXPECT_LE(writer.Lead(), 20);
  writer.Send(100, 20);
}

TEST(WriterTable, AForgerBesideTheTrueWriterIsNeverSecondsAhead) {
  for (const std::int64_t step : {1, 2, 8}) {
    OneWriter writer;
    writer.Send(200, 20);
    std::int64_t highest = writer.Sent();
    for (int tick = 0; tick < 10 * 20; ++tick) {
      for (int packet = 0; packet < 100; ++packet) {  // 2000 a second, for 10 s
        if (writer.Sample(highest + step)) highest += step;
        writer.Wait(kForgersPeriod);
      }
      const std::int64_t number = writer.Next();
      ASSERT_TRUE(writer.Sample(number)) << number << ", step " << step << ", before " << highest;
      highest = std::max(highest, number);
    }
    EXPECT_LE(writer.Lead(), 5 * 20) << "5 s";
    writer.Send(100, 20);
  }
}

// Regression: numbers below the highest did not update the time at which the writer was last heard,
// so the step allowed for silence grew while it spoke.
TEST(WriterTable, SavesNothingUpWhileItIsHeard) {
  OneWriter writer;
  writer.Send(100, 20);
  const std::int64_t highest = writer.Sent();
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(writer.Sample(highest));
    writer.Wait(milliseconds(50));
  }
  EXPECT_FALSE(writer.Sample(highest + 40));
  EXPECT_TRUE(writer.Sample(highest + 8));
}

// Readers without reliability ignore it, and the filter must not let samples follow it.
TEST(WriterTable, WhatAHeartbeatClaimsMovesNoSamplesOfAWriterThatSendsNone) {
  OneWriter writer;
  writer.Send(200, 20);
  EXPECT_TRUE(writer.Range(writer.Sent() + 60));
  EXPECT_FALSE(writer.Range(writer.Sent() + 100));
  EXPECT_FALSE(writer.Sample(writer.Sent() + 60));
  writer.Send(100, 20);
}

TEST(WriterTable, BelievesNoJumpWhileItIsHeardBehind) {
  OneWriter writer;
  writer.Send(100, 20);
  ASSERT_TRUE(writer.Sample(writer.Sent() + 8));
  for (std::int64_t i = 0; i < 100; ++i) {
    ASSERT_TRUE(writer.Sample(writer.Sent() - 30 + i % 20));
    writer.Wait(milliseconds(25));
    ASSERT_FALSE(writer.Sample(1'000'000 + i));
    writer.Wait(milliseconds(25));
  }
}

// Regression: its repairs, in every packet before the new samples, hid how far it is.
TEST(WriterTable, HearsHowFarAReliableWriterIsWhateverItSendsAgain) {
  OneWriter writer;
  ASSERT_TRUE(writer.Range(writer.Sent()));
  writer.Send(200, 20);
  writer.Lose(2000, 1000);
  int refused = 0;
  for (; !writer.Range(writer.Sent()); ++refused) {
    ASSERT_LT(refused, 100);
    ASSERT_TRUE(writer.Range(250));
    ASSERT_TRUE(writer.Sample(120));
    writer.Wait(milliseconds(100));
  }
  EXPECT_GT(refused, 0);
}

// A reliable writer may say nothing for minutes; the library takes hours to step so far.
TEST(WriterTable, BelievesNoRangeThatTheLibraryWouldStepThroughForSeconds) {
  constexpr std::int64_t kFar = 4'000'000'000;
  OneWriter heard;
  ASSERT_TRUE(heard.Range(heard.Sent()));
  heard.Wait(seconds(10));
  OneWriter never_heard;
  for (int i = 0; i < 100; ++i) {
    ASSERT_FALSE(heard.Range(kFar));
    ASSERT_FALSE(heard.Range(2 * WriterTable::kMostAtFirst));
    ASSERT_FALSE(never_heard.Range(kFar));
    heard.Wait(milliseconds(50));
    never_heard.Wait(milliseconds(50));
  }
}

TEST(WriterTable, HearsSamplesAndRangesOfAWriterThatIsYearsOld) {
  OneWriter samples;
  OneWriter ranges;
  int refused = 0;
  for (; !samples.Sample((std::int64_t{1} << 40U) + refused); ++refused) {
    ASSERT_FALSE(ranges.Range(4 * WriterTable::kMostAtFirst));
    ASSERT_LT(refused, 20);
    samples.Wait(milliseconds(50));
    ranges.Wait(milliseconds(50));
  }
  EXPECT_TRUE(ranges.Range(4 * WriterTable::kMostAtFirst));
}

// How many of the counts that reach one peer pass, each a step beyond the last one.
int CountsThatPass(std::uint32_t fleet, int packets, std::int64_t step, Nanoseconds apart) {
  WriterTable table(64, 4711, fleet);
  SteadyTime now = kMeeting;
  std::int64_t count = 1;
  int passed = 0;
  for (int i = 0; i < packets; ++i) {
    passed += table.IsPlausible(Guid(1), count, Statement::kCount, now) ? 1 : 0;
    count += step;
    now += apart;
  }
  return passed;
}

// Regression: the library counts the ACKNACKs of a reader to all of its writers as one. An observer
// that acknowledged the statuses of 75 vehicles and more was heard by none of them again.
TEST(WriterTable, PassesTheCountsOfAReaderThatAnswersAWholeFleet) {
  for (const std::uint32_t fleet : {2U, 30U, 75U, 100U, 200U, 500U}) {
    EXPECT_EQ(CountsThatPass(fleet, 300, fleet, milliseconds(200)), 300) << fleet;
  }
}

// Regression: 2.9.1 asks each writer of discovery that does not answer 14 times a second, and
// counts that too: what it sent to the others from then on was refused.
TEST(WriterTable, PassesTheCountsOfAReaderThatAsksManyStrangers) {
  for (const std::int64_t rate_hz : {300, 1000, 5000}) {
    WriterTable table(64, 4711, 2);
    SteadyTime now = kMeeting;
    std::int64_t count = 1;
    ASSERT_TRUE(table.IsPlausible(Guid(1), count, Statement::kCount, now));
    now += seconds(20);  // 14 of them a second
    count += 280;
    ASSERT_TRUE(table.IsPlausible(Guid(1), count, Statement::kCount, now));
    int refused = 0;
    for (int second = 0; second < 100; ++second) {
      now += seconds(1);
      count += rate_hz;
      refused += table.IsPlausible(Guid(1), count, Statement::kCount, now) ? 0 : 1;
    }
    EXPECT_LE(refused, 3) << rate_hz;
    EXPECT_FALSE(table.IsPlausible(Guid(1), 0xffff'ffff, Statement::kCount, now));
  }
}

TEST(WriterTable, ForgetsStrangersBeforeTheFleet) {
  WriterTable table(64, 4711);
  SteadyTime now = kMeeting;
  for (std::uint32_t round = 0; round < WriterTable::kKnown + 1; ++round) {
    for (std::uint32_t own = 0; own < 16; ++own)
      table.IsPlausible(Guid(own), 1 + round, Statement::kSample, now);
    now += milliseconds(50);
  }
  for (std::uint32_t stranger = 1000; stranger < 100'000; ++stranger) {
    table.IsPlausible(Guid(stranger), 1, Statement::kSample, now += milliseconds(1));
  }
  for (std::uint32_t own = 0; own < 16; ++own) {
    EXPECT_FALSE(table.IsPlausible(Guid(own), std::int64_t{1} << 20U, Statement::kSample, now))
        << "any first number of a forgotten writer is plausible: " << own;
  }
}

}  // namespace
}  // namespace giveway::link
