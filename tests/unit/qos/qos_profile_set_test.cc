#include <gtest/gtest.h>

#include "services/qos/profile_set.h"
#include "services/qos/xml_value.h"

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
  // The library reads it the same way; the schema check reports that it is truncated.
  EXPECT_EQ(set.profiles.front().Number(Policy::kMaxInstances), -1);
}

XmlElement Duration(const std::string& inside) {
  return *ReadXml("<period>" + inside + "</period>", "qos.xml").root;
}

TEST(Durations, AreSecondsAndNanosecondsOrInfinite) {
  EXPECT_EQ(ReadDuration(Duration("<sec>2</sec><nanosec>5</nanosec>")), 2'000'000'005);
  EXPECT_EQ(ReadDuration(Duration("<nanosec>7</nanosec>")), 7);
  EXPECT_EQ(ReadDuration(Duration("DURATION_INFINITY")), kInfinite);
  EXPECT_EQ(ReadDuration(Duration("<sec>DURATION_INFINITE_SEC</sec>")), kInfinite);
  EXPECT_EQ(ReadDuration(Duration("<sec>2147483647</sec><nanosec>4294967295</nanosec>")),
            kInfinite);
  // To the library the seconds alone are a time, which never matches where infinite is offered.
  EXPECT_EQ(ReadDuration(Duration("<sec>2147483647</sec>")), 2'147'483'647'000'000'000);
  for (const char* wrong : {"", "1", "<sec/>", "<sec>-1</sec>", "<sec>s</sec>",
                            "<nanosec>1000000000</nanosec>", "<nanosec>-1</nanosec>"}) {
    EXPECT_EQ(ReadDuration(Duration(wrong)), std::nullopt) << wrong;
  }
}

// 500 us with zeros forgotten looked like nothing.
TEST(Durations, AreWrittenWithAllDigitsThatSaySomething) {
  EXPECT_EQ(DurationText(1'000'000'000), "1 s");
  EXPECT_EQ(DurationText(1'000'500'000), "1.0005 s");
  EXPECT_EQ(DurationText(250'000'000), "250 ms");
  EXPECT_EQ(DurationText(1), "0.000001 ms");
  EXPECT_EQ(DurationText(kInfinite), "infinite");
}

TEST(Numbers, AreReadAsTheLibraryReadsThem) {
  const auto read = [](const char* text, NumberKind kind = NumberKind::kSigned) {
    const auto number = ReadNumber(text, kind);
    return number ? std::pair(number->value, number->exact) : std::pair(std::int64_t{-999}, false);
  };
  for (const char* four : {"4", " 4 ", "\n  4\n", "\t+4", "4.0", "4.", "0x4", " 0X4 ", "04"}) {
    EXPECT_EQ(read(four), std::pair(std::int64_t{4}, true)) << four;
    EXPECT_EQ(read(four, NumberKind::kUnsigned), std::pair(std::int64_t{4}, true)) << four;
  }
  for (const char* cut : {"4ms", "4.5", "4 5", "4,0", "4e3", "4.0.0"}) {
    EXPECT_EQ(read(cut), std::pair(std::int64_t{4}, false)) << cut;
  }
  EXPECT_EQ(read("-1"), std::pair(std::int64_t{-1}, true));
  EXPECT_EQ(read("-1", NumberKind::kUnsigned), std::pair(std::int64_t{0xffff'ffff}, true));
  EXPECT_FALSE(read("-2", NumberKind::kUnsigned).second);
  EXPECT_FALSE(read("5000000000").second);
  for (const char* none : {"", " ", "four", "+", ".4", "- 4"}) {
    EXPECT_EQ(read(none).first, -999) << none;
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
