#include <gtest/gtest.h>

#include "services/qos/profile_set.h"
#include "services/qos/schema_check.h"

namespace giveway::qos {
namespace {

ProfileSet Read(const std::string& profiles) {
  const XmlRead read = ReadXml("<dds><profiles>" + profiles + "</profiles></dds>", "qos.xml");
  EXPECT_TRUE(read.root.has_value());
  return ReadProfiles(*read.root, "qos.xml");
}

TEST(ProfileSet, TakesTheLibrarysDefaultWhereTheFileIsSilent) {
  const ProfileSet set = Read("<data_writer profile_name='w'/><data_reader profile_name='r'/>");
  const Profile* writer = set.Find(Owner::kWriter, "w");
  const Profile* reader = set.Find(Owner::kReader, "r");
  ASSERT_TRUE(writer != nullptr && reader != nullptr);
  EXPECT_EQ(writer->Number(Policy::kReliability), kReliable);
  EXPECT_EQ(reader->Number(Policy::kReliability), kBestEffort);
  EXPECT_EQ(writer->Number(Policy::kMaxInstances), 10);
  EXPECT_FALSE((*writer)[Policy::kMaxInstances].given);
}

TEST(ProfileSet, RemembersTheLineOfEachValue) {
  const ProfileSet set = Read(
      "\n<data_writer "
      "profile_name='w'>\n<qos>\n<deadline><period>\n<sec>1</sec></period></deadline>"
      "\n<durability><kind>VOLATILE</kind></durability></qos></data_writer>");
  const Profile& writer = set.profiles.front();
  EXPECT_EQ(writer.place.line, 2);
  EXPECT_EQ(writer[Policy::kDeadline].place.line, 4);
  EXPECT_EQ(writer[Policy::kDurability].place.line, 6);
  EXPECT_EQ(writer.Number(Policy::kDeadline), 1'000'000'000);
}

TEST(ProfileSet, LeavesOutWhatMeansNothing) {
  const ProfileSet set = Read(
      "<data_writer profile_name='w'><qos><reliability><kind>SOMEHOW</kind></reliability></qos>"
      "<topic><historyQos><depth>many</depth></historyQos><resourceLimitsQos><max_instances>"
      "9223372036854775807</max_instances></resourceLimitsQos></topic></data_writer>");
  EXPECT_EQ(set.profiles.front().Number(Policy::kReliability), kReliable);
  EXPECT_EQ(set.profiles.front().Number(Policy::kDepth), 1);
  EXPECT_EQ(set.profiles.front().Number(Policy::kMaxInstances), 10);
}

XmlElement Duration(const std::string& inside) {
  return *ReadXml("<period>" + inside + "</period>", "qos.xml").root;
}

TEST(Durations, AreSecondsAndNanosecondsOrInfinite) {
  EXPECT_EQ(ParseDuration(Duration("<sec>2</sec><nanosec>5</nanosec>")), 2'000'000'005);
  EXPECT_EQ(ParseDuration(Duration("<nanosec>7</nanosec>")), 7);
  EXPECT_EQ(ParseDuration(Duration("DURATION_INFINITY")), kInfinite);
  EXPECT_EQ(ParseDuration(Duration("<sec>DURATION_INFINITE_SEC</sec>")), kInfinite);
  EXPECT_EQ(ParseDuration(Duration("<sec>2147483647</sec>")), kInfinite);
  for (const char* wrong : {"", "1", "<sec/>", "<sec>-1</sec>", "<sec>1.5</sec>", "<sec>1 s</sec>",
                            "<nanosec>1000000000</nanosec>", "<sec>99999999999999999999</sec>"}) {
    EXPECT_EQ(ParseDuration(Duration(wrong)), std::nullopt) << wrong;
  }
}

TEST(PolicyTexts, ReadAsTheyWouldBeWritten) {
  EXPECT_EQ(Text(Policy::kDurability, kTransientLocal), "TRANSIENT_LOCAL");
  EXPECT_EQ(Text(Policy::kDeadline, 150'000'000), "150 ms");
  EXPECT_EQ(Text(Policy::kDeadline, 1'500'000), "1.5 ms");
  EXPECT_EQ(Text(Policy::kParticipantLease, 10'000'000'000), "10 s");
  EXPECT_EQ(Text(Policy::kDeadline, kInfinite), "infinite");
  EXPECT_EQ(Text(Policy::kParticipantId, -1), "-1");
  EXPECT_EQ(Text(Policy::kBuiltinTransports, 0), "false");
}

TEST(Policies, StandInTheOrderOfTheirNumbers) {
  for (std::size_t i = 0; i < kPolicyCount; ++i) {
    EXPECT_EQ(Index(Policies()[i].policy), i);
    EXPECT_EQ(&Info(Policies()[i].policy), &Policies()[i]);
  }
}

}  // namespace
}  // namespace giveway::qos
