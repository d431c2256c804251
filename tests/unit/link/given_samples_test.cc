#include "services/link/inbox/given_samples.h"

#include <gtest/gtest.h>

namespace giveway::link {
namespace {

constexpr std::size_t kEventTopic = 8;
constexpr std::size_t kRosterTopic = 9;
constexpr std::uint64_t kEventWriter = 5;

TEST(GivenSamples, NothingIsGivenAgainByAParticipantThatContinues) {
  GivenSamples given;
  for (const std::uint64_t sequence : {1U, 3U, 2U, 3U}) {
    EXPECT_FALSE(given.IsGivenAgain(kEventTopic, kEventWriter, sequence));
  }
}

TEST(GivenSamples, TheNextParticipantIsGivenAgainWhatTheLastHad) {
  GivenSamples given;
  given.IsGivenAgain(kEventTopic, kEventWriter, 1);
  given.IsGivenAgain(kEventTopic, kEventWriter, 2);
  given.Renew();
  EXPECT_TRUE(given.IsGivenAgain(kEventTopic, kEventWriter, 1));
  EXPECT_TRUE(given.IsGivenAgain(kEventTopic, kEventWriter, 2));
  EXPECT_FALSE(given.IsGivenAgain(kEventTopic, kEventWriter, 3));
  given.Renew();
  EXPECT_TRUE(given.IsGivenAgain(kEventTopic, kEventWriter, 3));
}

TEST(GivenSamples, OfOtherTopicsAndWritersNothingIs) {
  GivenSamples given;
  given.IsGivenAgain(kEventTopic, kEventWriter, 2);
  given.Renew();
  EXPECT_FALSE(given.IsGivenAgain(kRosterTopic, kEventWriter, 1));
  EXPECT_FALSE(given.IsGivenAgain(kEventTopic, kEventWriter + 1, 1))
      << "the next world's first event";
}

TEST(GivenSamples, WritersWithoutEndTakeBoundedMemory) {
  GivenSamples given;
  for (std::uint64_t writer = 1; writer <= 2 * GivenSamples::kMostWriters; ++writer) {
    given.IsGivenAgain(kEventTopic, writer, 1);
  }
  EXPECT_EQ(given.Writers(), GivenSamples::kMostWriters);
  given.Renew();
  EXPECT_TRUE(given.IsGivenAgain(kEventTopic, 2 * GivenSamples::kMostWriters, 1));
}

}  // namespace
}  // namespace giveway::link
