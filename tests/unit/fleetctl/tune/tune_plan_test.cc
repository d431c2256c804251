// What `fleetctl qos tune` tries.
#include "services/fleetctl/tune/tune_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "services/qos/profile_check.h"

namespace giveway::fleetctl {
namespace {

using std::chrono::milliseconds;

const BeaconQos kBase{.offered = milliseconds(100),
                      .requested = milliseconds(150),
                      .lease = milliseconds(250),
                      .reliable = false,
                      .depth = 5};

std::string DefaultSet() {
  std::ifstream stream(std::filesystem::path(GIVEWAY_QOS_SETS) / "default.xml");
  return {std::istreambuf_iterator<char>(stream), {}};
}

qos::ProfileSet Read(const std::string& bytes) {
  return qos::ReadProfiles(*qos::ReadXml(bytes, "f.xml").root, "f.xml");
}

TEST(TunePlan, TheBaseIsWhatTheFileSays) {
  EXPECT_EQ(WhyNotTunable(Read(DefaultSet())), "");
  EXPECT_EQ(BeaconQosOf(Read(DefaultSet())), kBase);
}

TEST(TunePlan, ASetWithoutADeadlineCannotBeTuned) {
  EXPECT_NE(WhyNotTunable(Read("<profiles/>")), "");
  EXPECT_NE(WhyNotTunable(Read("<profiles><data_writer profile_name='fleet_beacon_writer'/>"
                               "<data_reader profile_name='fleet_beacon_reader'/></profiles>")),
            "");
}

TEST(TunePlan, TheBaseComesFirstAndEveryQosOnce) {
  for (const bool quick : {false, true}) {
    const auto candidates = MakeCandidates(kBase, {.quick = quick});
    EXPECT_EQ(candidates.front().name, "base");
    EXPECT_EQ(candidates.front().qos, kBase);
    std::set<std::string> names;
    for (const TuneCandidate& one : candidates) {
      names.insert(one.name);
      for (const TuneCandidate& other : candidates) {
        EXPECT_EQ(one.qos == other.qos, &one == &other) << one.name;
      }
    }
    EXPECT_EQ(names.size(), candidates.size());
    EXPECT_EQ(candidates.size(), quick ? 10U : 34U);
  }
}

TEST(TunePlan, EverythingThatIsSearchedVaries) {
  std::set<std::int64_t> offered, requested, leases, depths;
  std::set<bool> reliable;
  for (const TuneCandidate& one : MakeCandidates(kBase, {})) {
    offered.insert(one.qos.offered.count());
    requested.insert(one.qos.requested.count());
    leases.insert(one.qos.lease.count());
    depths.insert(one.qos.depth);
    reliable.insert(one.qos.reliable);
    EXPECT_LE(one.qos.offered, one.qos.requested) << one.name;
  }
  EXPECT_GE(offered.size(), 3U);
  EXPECT_GE(requested.size(), 8U);
  EXPECT_EQ(leases.size(), 3U);
  EXPECT_EQ(depths.size(), 3U);
  EXPECT_EQ(reliable.size(), 2U);
}

TEST(TunePlan, NoMoreThanAskedFor) {
  EXPECT_EQ(MakeCandidates(kBase, {.most = 3}).size(), 3U);
  EXPECT_EQ(MakeCandidates(kBase, {.most = 0}).size(), 1U);
}

TEST(TunePlan, EveryCandidateBecomesAFileThatSaysItAndPassesTheCheck) {
  const std::string base = DefaultSet();
  for (const TuneCandidate& one : MakeCandidates(kBase, {})) {
    const auto edited = qos::Edit(base, "f.xml", EditsOf(one.qos, kBase));
    ASSERT_TRUE(edited.findings.empty()) << one.name;
    EXPECT_EQ(BeaconQosOf(Read(edited.bytes)), one.qos) << one.name;
    EXPECT_LT(qos::ExitCode(qos::Check({{"f.xml", edited.bytes}}, {})), 2) << one.name;
  }
}

TEST(TunePlan, TheBaseNeedsNoEdit) { EXPECT_TRUE(EditsOf(kBase, kBase).empty()); }

TEST(TunePlan, EachRungHalvesTheCandidatesAndDoublesTheTrials) {
  const auto rungs = MakeRungs(9, false);
  ASSERT_EQ(rungs.size(), 4U);
  for (std::size_t i = 1; i < rungs.size(); ++i) {
    EXPECT_EQ(rungs[i].candidates, (rungs[i - 1].candidates + 1) / 2);
    EXPECT_EQ(rungs[i].trials, rungs[i - 1].trials * 2);
  }
  EXPECT_EQ(MakeRungs(9, true).size(), 2U);
  EXPECT_EQ(MakeRungs(1, false).size(), 1U);
}

TEST(TunePlan, VerificationMeetsOtherSeedsThanTheSearch) {
  std::set<std::uint32_t> seeds;
  for (std::uint32_t trial = 0; trial < 100; ++trial) {
    seeds.insert(TrialSeed(1, false, trial));
    seeds.insert(TrialSeed(1, true, trial));
  }
  EXPECT_EQ(seeds.size(), 200U);
  EXPECT_EQ(TrialSeed(1, false, 3), TrialSeed(1, false, 3));
  EXPECT_NE(TrialSeed(1, false, 3), TrialSeed(2, false, 3));
}

}  // namespace
}  // namespace giveway::fleetctl
