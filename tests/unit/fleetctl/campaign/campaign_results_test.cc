// Results from files and logs: those that are there, and a message for what is none.
#include "services/fleetctl/campaign/campaign_results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "services/config/text_file.h"
#include "services/fleetctl/campaign/campaign_json.h"
#include "tests/unit/config/scenario_files.h"
#include "tests/unit/fleetctl/campaign/campaign_plans.h"

namespace giveway::fleetctl {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string LineOf(std::uint32_t index) {
  return ToJson(PretendedShard(SmallCampaign(), {index, 3}));
}

struct HadResults {
  std::vector<NamedShard> shards;
  std::string problems;
};

HadResults ResultsIn(const std::string& file) {
  HadResults had;
  ProblemList problems;
  ReadResults(file, &had.shards, &problems);
  had.problems = Format(problems.Sorted());
  return had;
}

TEST(CampaignResults, StandAmongTheLinesOfALog) {
  const TempFolder folder;
  const std::string file =
      folder.Write("log", "a < b [[[ (\xff\n" + LineOf(1) + "\n\n {no result}\n" + LineOf(0));
  const HadResults had = ResultsIn(file);
  EXPECT_EQ(had.problems, "");
  ASSERT_EQ(had.shards.size(), 2U);
  EXPECT_EQ(had.shards[0].result.shard.index, 1U);
  EXPECT_EQ(had.shards[0].where, file);
  EXPECT_EQ(had.shards[1].result.shard.index, 0U);
  EXPECT_EQ(had.shards[1].where, file + ":5");
}

// The results of all pods of a large campaign come in one stream.
TEST(CampaignResults, AreFoundInALogOfAnySize) {
  const TempFolder folder;
  const std::string noise(kMaxFileBytes, 'x');
  const HadResults had = ResultsIn(folder.Write("log", noise + "\n" + LineOf(2) + "\n"));
  EXPECT_EQ(had.problems, "");
  ASSERT_EQ(had.shards.size(), 1U);
}

TEST(CampaignResults, SaysWhichLinesAreNone) {
  const TempFolder folder;
  std::string endless = "{";
  endless.append(kMaxFileBytes, 'x');
  const HadResults had =
      ResultsIn(folder.Write("log", "{\xff\n" + LineOf(0) + "\n{}\n" + endless + "\n"));
  EXPECT_EQ(had.shards.size(), 1U);
  EXPECT_THAT(had.problems,
              AllOf(HasSubstr("log: is no result"), HasSubstr("log:3: is of format 0"),
                    HasSubstr("log:4: has a line of more than")));
}

TEST(CampaignResults, SaysWhatIsNoFileOfResults) {
  const TempFolder folder;
  EXPECT_THAT(ResultsIn(folder.Write("log", "")).problems, HasSubstr("no line of it is a result"));
  EXPECT_THAT(ResultsIn(folder.Path() + "/none").problems, HasSubstr("does not exist"));
  EXPECT_THAT(ResultsIn(folder.Path()).problems, HasSubstr("is a directory"));
  EXPECT_THAT(ResultsIn("/dev/zero").problems, HasSubstr("is no regular file"));
  EXPECT_THAT(ResultsIn("/proc/self/mem").problems, HasSubstr("cannot be read to its end"));
}

}  // namespace
}  // namespace giveway::fleetctl
