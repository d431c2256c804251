// Filters judge a sample by the very key that the library stores it under.
#include "services/link/sample_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "services/link/fastdds/topics.h"
#include "services/link/inbox/participant_of.h"

namespace giveway::link {
namespace {

constexpr VehicleId kSeven{7};
constexpr VehicleId kEight{8};
constexpr std::size_t kHeader = 4;  // of the encapsulation

rtps::GUID_t WriterOf(std::uint8_t participant) {
  rtps::GUID_t guid;
  guid.guidPrefix.value[0] = participant;
  guid.entityId.value[3] = 2;
  return guid;
}

// A sample as it comes from the participant of this number.
struct Received {
  explicit Received(std::uint8_t participant) { change.writerGUID = WriterOf(participant); }
  Received(VehicleId vehicle, std::uint8_t participant) : Received(participant) {
    SetPayload({0, 1, 0, 0, static_cast<std::uint8_t>(Number(vehicle)), 0, 0, 0, 0, 0, 0, 0});
  }
  // Of `bytes`, of which the encapsulation header and the key count.
  void SetPayload(const std::vector<std::uint8_t>& bytes) {
    change.serializedPayload.reserve(static_cast<std::uint32_t>(bytes.size()));
    std::ranges::copy(bytes, change.serializedPayload.data);
    change.serializedPayload.length = static_cast<std::uint32_t>(bytes.size());
  }
  void SetKeyHash(VehicleId vehicle) {
    change.instanceHandle.value[3] = static_cast<std::uint8_t>(Number(vehicle));
  }
  rtps::CacheChange_t change;
};

// Participant 1 owns vehicle 7.
class OfAnOwner : public ::testing::Test {
 protected:
  OfAnOwner() { filter_.SetOwner(kSeven, ParticipantOf(WriterOf(1))); }
  bool Passes(const Received& received, bool digests = false) {
    return filter_.Passes(received.change, {&filter_, 1, digests}, SteadyTime{0});
  }
  std::string WhyNot() {
    std::vector<Refusal> refusals;
    filter_.TakeRefusals(&refusals);
    if (refusals.empty()) return {};
    return std::string(refusals.front().field) + ": " + refusals.front().why;
  }
  OwnerFilter filter_{"motor command"};
};

TEST_F(OfAnOwner, SamplesOfItsParticipantPass) {
  EXPECT_TRUE(Passes(Received(kSeven, 1)));
  EXPECT_FALSE(Passes(Received(kSeven, 2)));
  EXPECT_EQ(WhyNot(), "writer: another participant joined with this id");
}

TEST_F(OfAnOwner, ASampleWithTheKeyHashOfAnotherIsRefused) {
  Received of_another(kEight, 2);
  EXPECT_TRUE(Passes(of_another));
  of_another.SetKeyHash(kEight);
  EXPECT_TRUE(Passes(of_another));
  of_another.SetKeyHash(kSeven);
  EXPECT_FALSE(Passes(of_another));
  EXPECT_EQ(WhyNot(), "key: its key hash is not of its key");
}

TEST_F(OfAnOwner, AHashThatIsOfNoKeyIsRefused) {
  Received received(kSeven, 1);
  received.SetKeyHash(kSeven);
  received.change.instanceHandle.value[9] = 1;
  EXPECT_FALSE(Passes(received));
}

TEST_F(OfAnOwner, ASampleTooShortForAKeyIsRefused) {
  Received received(2);
  received.SetPayload({0, 1, 0, 0, 7, 0});
  EXPECT_FALSE(Passes(received));
  EXPECT_EQ(WhyNot(), "key: it is too short for a key");
  received.SetKeyHash(kSeven);
  EXPECT_FALSE(Passes(received));
}

TEST_F(OfAnOwner, ADisposeIsJudgedByTheInstanceThatItNames) {
  Received dispose(kEight, 2);
  dispose.change.kind = rtps::NOT_ALIVE_DISPOSED;
  dispose.SetKeyHash(kSeven);
  EXPECT_FALSE(Passes(dispose));
  EXPECT_EQ(WhyNot(), "writer: another participant joined with this id");
  dispose.change.writerGUID = WriterOf(1);
  EXPECT_TRUE(Passes(dispose));
  Received without_payload(2);
  without_payload.change.kind = rtps::NOT_ALIVE_UNREGISTERED;
  without_payload.SetKeyHash(kSeven);
  EXPECT_FALSE(Passes(without_payload));
}

TEST_F(OfAnOwner, WhereHashesAreDigestsTheKeyIsThatOfThePayload) {
  Received received(kSeven, 1);
  received.change.instanceHandle.value[9] = 1;
  EXPECT_TRUE(Passes(received, true));
  received.change.writerGUID = WriterOf(2);
  EXPECT_FALSE(Passes(received, true));
}

constexpr SteadyTime kBegun = std::chrono::seconds(100);
constexpr SteadyTime kAMoment = std::chrono::milliseconds(1);

TEST(FirstComerFilter, OneThatIsSilentForAFewTicksKeepsTheWord) {
  FirstComerFilter filter("status");
  const FilterOfTopic topic{&filter, 1, false};
  const auto passes = [&](std::uint8_t participant, SteadyTime now) {
    return filter.Passes(Received(kSeven, participant).change, topic, now);
  };
  EXPECT_TRUE(passes(1, kBegun));
  EXPECT_FALSE(passes(2, kBegun + FirstComerFilter::kSilence));
  filter.SetTickPeriod(std::chrono::milliseconds(500));
  EXPECT_FALSE(passes(2, kBegun + std::chrono::milliseconds(2500)));
  EXPECT_TRUE(passes(2, kBegun + std::chrono::milliseconds(2500) + kAMoment));
  EXPECT_FALSE(passes(1, kBegun + std::chrono::milliseconds(2500) + kAMoment));
}

TEST(FirstComerFilter, KnowsWhoSpoke) {
  FirstComerFilter filter("status");
  const auto spoke = [&](std::uint8_t participant) {
    return filter.Spoke(kSeven, ParticipantOf(WriterOf(participant)));
  };
  EXPECT_FALSE(spoke(1));
  filter.Passes(Received(kSeven, 1).change, {&filter, 1, false}, kBegun);
  EXPECT_TRUE(spoke(1));
  EXPECT_FALSE(spoke(2));
  filter.Passes(Received(kSeven, 2).change, {&filter, 1, false}, kBegun + std::chrono::seconds(2));
  EXPECT_TRUE(spoke(1)) << "what it said last may not have been read yet";
  EXPECT_TRUE(spoke(2));
  EXPECT_FALSE(filter.Spoke(kEight, ParticipantOf(WriterOf(1))));
}

TEST(FirstWorldFilter, OneThatIsThereAndSilentForAFewTicksKeepsTheWord) {
  bool is_there = true;
  FirstWorldFilter filter("sample of a world", [&](std::uint64_t) { return is_there; });
  const FilterOfTopic topic{&filter, 1, false};
  const auto passes = [&](std::uint8_t participant, SteadyTime now) {
    return filter.Passes(Received(kSeven, participant).change, topic, now);
  };
  EXPECT_TRUE(passes(1, kBegun));
  EXPECT_FALSE(passes(2, kBegun + FirstWorldFilter::kSilence));
  EXPECT_FALSE(filter.Spoke(ParticipantOf(WriterOf(2))));
  filter.SetTickPeriod(std::chrono::milliseconds(200));
  EXPECT_FALSE(passes(2, kBegun + std::chrono::seconds(1)));
  EXPECT_TRUE(passes(2, kBegun + std::chrono::seconds(1) + kAMoment));
  EXPECT_TRUE(filter.Spoke(ParticipantOf(WriterOf(2))));
  is_there = false;
  EXPECT_TRUE(passes(3, kBegun + std::chrono::seconds(1) + kAMoment)) << "the other has left";
}

template <typename Wire>
void ExpectItsKeyIsThatOfTheLibrary() {
  SCOPED_TRACE(TopicOf<Wire>::kName);
  typename TopicOf<Wire>::Type type;
  Wire sample;
  Received received(1);
  received.change.serializedPayload.reserve(SerializedSize(type, &sample));
  ASSERT_TRUE(Serialize(type, &sample, received.change.serializedPayload));
  constexpr std::size_t kNumbers = TopicOf<Wire>::kKeyNumbers;
  for (std::size_t i = 0; i < 4 * kNumbers; ++i) {
    received.change.serializedPayload.data[kHeader + i] = static_cast<std::uint8_t>(i + 1);
  }
  ASSERT_TRUE(Deserialize(type, received.change.serializedPayload, &sample));
  EXPECT_EQ(ComputeInstance(type, &sample, &received.change.instanceHandle), kNumbers != 0);
  const KeyReader key(received.change, {nullptr, kNumbers, false});
  EXPECT_EQ(key.WhyNot(), nullptr);
  EXPECT_EQ(key.Vehicle().has_value(), kNumbers == 1);
  EXPECT_EQ(key.Session().has_value(), kNumbers == 4);
}

TEST(KeyReader, OfEveryTopicItReadsTheKeyThatTheLibraryStoresItUnder) {
#define GIVEWAY_EXPECT(wire_type, name, profile, key_numbers) \
  ExpectItsKeyIsThatOfTheLibrary<wire::wire_type>();
  GIVEWAY_TOPICS(GIVEWAY_EXPECT)
#undef GIVEWAY_EXPECT
}

}  // namespace
}  // namespace giveway::link
