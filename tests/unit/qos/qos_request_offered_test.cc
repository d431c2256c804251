#include <gmock/gmock.h>

#include "services/qos/request_offered.h"

namespace giveway::qos {
namespace {

Profile With(Owner owner, Policy policy, std::int64_t number) {
  Profile profile = DefaultProfile(owner, "p");
  profile.values[Index(policy)].number = number;
  return profile;
}

std::vector<std::string> Names(const std::vector<const MatchRule*>& rules) {
  std::vector<std::string> names;
  for (const MatchRule* rule : rules) names.emplace_back(rule->name);
  return names;
}

TEST(RequestOffered, TheDefaultsMatch) {
  const Profile writer = DefaultProfile(Owner::kWriter, "w");
  const Profile reader = DefaultProfile(Owner::kReader, "r");
  EXPECT_TRUE(WillMatch(writer, reader));
  EXPECT_TRUE(Broken(writer, reader).empty());
}

struct Pair {
  Policy policy;
  std::int64_t offered;
  std::int64_t requested;
  bool match;
};

class OnePolicy : public ::testing::TestWithParam<Pair> {};

TEST_P(OnePolicy, IsOfferedAtLeastAsRequested) {
  const auto [policy, offered, requested, match] = GetParam();
  const Profile writer = With(Owner::kWriter, policy, offered);
  const Profile reader = With(Owner::kReader, policy, requested);
  EXPECT_EQ(WillMatch(writer, reader), match);
  EXPECT_EQ(Broken(writer, reader).size(), match ? 0U : 1U);
}

INSTANTIATE_TEST_SUITE_P(
    Pairs, OnePolicy,
    ::testing::Values(Pair{Policy::kReliability, kBestEffort, kReliable, false},
                      Pair{Policy::kReliability, kReliable, kBestEffort, true},
                      Pair{Policy::kDurability, kVolatile, kTransientLocal, false},
                      Pair{Policy::kDurability, kTransientLocal, kTransientLocal, true},
                      Pair{Policy::kDeadline, 200, 150, false},
                      Pair{Policy::kDeadline, 150, 150, true},
                      Pair{Policy::kDeadline, kInfinite, 150, false},
                      Pair{Policy::kLiveliness, kAutomatic, kManualByTopic, false},
                      Pair{Policy::kLiveliness, kManualByTopic, kManualByParticipant, true},
                      Pair{Policy::kLease, 300, 250, false}, Pair{Policy::kLease, 100, 250, true},
                      Pair{Policy::kOwnership, kShared, kExclusive, false},
                      Pair{Policy::kOwnership, kExclusive, kShared, false},
                      Pair{Policy::kDisablePositiveAcks, 0, 1, false},
                      Pair{Policy::kDisablePositiveAcks, 1, 0, true}));

TEST(RequestOffered, NamesEveryPolicyThatIsBroken) {
  Profile reader = With(Owner::kReader, Policy::kDeadline, 100);
  reader.values[Index(Policy::kOwnership)].number = kExclusive;
  EXPECT_THAT(Names(Broken(DefaultProfile(Owner::kWriter, "w"), reader)),
              ::testing::ElementsAre("deadline_mismatch", "ownership_mismatch"));
}

// Other implementations refuse these; Fast DDS 2.9 does not look at them.
TEST(RequestOffered, TellsOfWhatOnlyOthersLookAtWithoutCallingItAMismatch) {
  const Profile reader = With(Owner::kReader, Policy::kPresentation, 2);
  const Profile writer = DefaultProfile(Owner::kWriter, "w");
  EXPECT_TRUE(WillMatch(writer, reader));
  EXPECT_THAT(Names(Broken(writer, reader)), ::testing::ElementsAre("presentation_mismatch"));
}

}  // namespace
}  // namespace giveway::qos
