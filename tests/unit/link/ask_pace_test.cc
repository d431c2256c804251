// How often a participant that does not answer is asked: by packets as Fast DDS 2.9.1 sends them.
#include "services/link/packet_filter/ask_pace.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <utility>
#include <vector>

#include "tests/support/rtps_packet.h"

namespace giveway::link {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::RtpsPacket;

constexpr SteadyTime kAskedFirst = seconds(1000);
constexpr test::PrefixBytes kAsker = {1, 15, 6};
constexpr test::PrefixBytes kSilent = {1, 15, 7};
constexpr test::PrefixBytes kOther = {1, 15, 8};

test::PacketBytes Ask(const test::PrefixBytes& of) {
  return RtpsPacket(kAsker).InfoDst(of).AckNack(test::kUserWriter, 0, 0, 0).Statistics().Bytes();
}

// Of questions every 70 ms, as the library has them: how many are sent in so much time.
int SentIn(Nanoseconds time, AskPace& pace, SteadyTime from) {
  int sent = 0;
  for (Nanoseconds at{0}; at < time; at += milliseconds(70)) {
    sent += pace.MayAsk(kSilent, from + at) ? 1 : 0;
  }
  return sent;
}

TEST(AskedParticipant, IsWhomAPacketAsksThatDoesNothingElse) {
  EXPECT_EQ(AskedParticipant(Ask(kSilent)), kSilent);
}

TEST(AskedParticipant, IsNoneOfWhatElseIsSent) {
  const auto to = [] { return RtpsPacket(kAsker).InfoDst(kSilent); };
  const auto asks = [](RtpsPacket packet) { return packet.AckNack(test::kUserWriter, 0, 0, 0); };
  const std::vector<std::pair<const char*, RtpsPacket>> sent = {
      {"acknowledges", to().AckNack(test::kUserWriter, 5, 0, 0)},
      {"asks for a number", to().AckNack(test::kUserWriter, 1, 1, 1)},
      {"a heartbeat", to().Heartbeat(test::kUserWriter, 1, 0, 1)},
      {"asks, and says how far it is", asks(to()).Heartbeat(test::kUserWriter, 1, 0, 1)},
      {"asks two participants", asks(asks(to()).InfoDst(kOther))},
      {"asks all", asks(RtpsPacket(kAsker))},
      {"announces itself", RtpsPacket(kAsker).InfoTs().Announcement(kAsker, 1)},
      {"nothing", to()}};
  for (const auto& [what, packet] : sent) {
    EXPECT_FALSE(AskedParticipant(packet.Bytes()).has_value()) << what;
  }
  EXPECT_FALSE(AskedParticipant({}).has_value());
}

// 5 000 forged announcements: 256 strangers were asked 43 times a second each for 20 s.
TEST(AskPace, FallsToOnceASecondWhereNobodyAnswers) {
  AskPace pace;
  EXPECT_EQ(SentIn(milliseconds(280), pace, kAskedFirst), 4) << "at first as the library asks";
  EXPECT_LE(SentIn(seconds(5), pace, kAskedFirst + milliseconds(280)), 16);
  EXPECT_LE(SentIn(seconds(60), pace, kAskedFirst + seconds(6)), 60);
  EXPECT_GE(SentIn(seconds(60), pace, kAskedFirst + seconds(70)), 50) << "one that returns is met";
}

TEST(AskPace, AsksAllWritersOfOneInATurn) {
  AskPace pace;
  SentIn(seconds(30), pace, kAskedFirst);
  SteadyTime now = kAskedFirst + seconds(40);
  ASSERT_TRUE(pace.MayAsk(kSilent, now));
  EXPECT_TRUE(pace.MayAsk(kSilent, now + milliseconds(30)));
  EXPECT_TRUE(pace.MayAsk(kSilent, now + milliseconds(60)));
  EXPECT_FALSE(pace.MayAsk(kSilent, now + milliseconds(130)));
  EXPECT_TRUE(pace.MayAsk(kOther, now + milliseconds(130))) << "each has its own pace";
}

TEST(AskPace, KeepsNothingOfOneThatAnswered) {
  AskPace pace;
  SentIn(seconds(30), pace, kAskedFirst);
  const auto announcement = RtpsPacket(kSilent).InfoTs().Announcement(kSilent, 1).Statistics();
  pace.Hear(announcement.Bytes());
  EXPECT_EQ(pace.Asked(), 1U) << "to announce itself is no answer";
  pace.Hear(RtpsPacket(kOther).Heartbeat(test::kUserWriter, 1, 0, 1).Bytes());
  EXPECT_EQ(pace.Asked(), 1U);
  pace.Hear(RtpsPacket(kSilent).InfoDst(kAsker).Heartbeat(test::kUserWriter, 1, 0, 1).Bytes());
  EXPECT_EQ(pace.Asked(), 0U);
  EXPECT_EQ(SentIn(milliseconds(280), pace, kAskedFirst + seconds(31)), 4)
      << "lost, and found again";
}

TEST(AskPace, StartsAgainWithOneThatTheLibraryHasFoundAgain) {
  AskPace pace;
  SentIn(seconds(30), pace, kAskedFirst);
  EXPECT_EQ(SentIn(milliseconds(280), pace, kAskedFirst + seconds(45)), 4);
}

TEST(AskPace, IsBounded) {
  AskPace pace;
  for (std::uint32_t i = 0; i < 2 * AskPace::kMostAsked; ++i) {
    test::PrefixBytes stranger = {1, 15};
    stranger[4] = static_cast<std::uint8_t>(i);
    stranger[5] = static_cast<std::uint8_t>(i >> 8U);
    EXPECT_TRUE(pace.MayAsk(stranger, kAskedFirst + milliseconds(i)));
  }
  EXPECT_EQ(pace.Asked(), AskPace::kMostAsked);
}

}  // namespace
}  // namespace giveway::link
