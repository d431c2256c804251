// Values are replaced in the text of a profile file; nothing else in it moves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/qos/profile_check.h"
#include "services/qos/profile_edit.h"
#include "services/qos/profile_set.h"
#include "tests/unit/qos/qos_files.h"

namespace giveway::qos {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kMs = 1'000'000;
const std::string kReader = "fleet_beacon_reader";

std::string Default() { return BytesOf(std::filesystem::path(GIVEWAY_QOS_SETS) / "default.xml"); }

std::string Edited(const std::string& bytes, const std::vector<ProfileEdit>& edits) {
  const EditedProfiles edited = Edit(bytes, "f.xml", edits);
  EXPECT_TRUE(edited.findings.empty());
  return edited.bytes;
}

std::int64_t Read(const std::string& bytes, Owner owner, const std::string& profile,
                  Policy policy) {
  const XmlRead read = ReadXml(bytes, "f.xml");
  return ReadProfiles(*read.root, "f.xml").Find(owner, profile)->Number(policy);
}

TEST(ProfileEdit, NoEditChangesNoByte) { EXPECT_EQ(Edited(Default(), {}), Default()); }

TEST(ProfileEdit, AnEditChangesItsValueAndNothingElse) {
  std::string expected = Default();
  const std::size_t profile = expected.find("profile_name=\"" + kReader);
  expected.replace(expected.find("150000000", profile), 9, "190000000");
  const auto edited = Edited(Default(), {{Owner::kReader, kReader, Policy::kDeadline, 190 * kMs}});
  EXPECT_EQ(edited, expected);
  EXPECT_EQ(Read(edited, Owner::kReader, kReader, Policy::kDeadline), 190 * kMs);
}

// What the tuner recommended after minutes of search was no XML, where its base started so.
TEST(ProfileEdit, ACommentStandsBehindTheDeclarationWhereverThatIs) {
  for (const std::string before : {"", "\xEF\xBB\xBF", "\n", "\xEF\xBB\xBF\r\n "}) {
    const std::string noted = WithComment(before + Default(), "two--hyphens");
    EXPECT_THAT(noted, HasSubstr("?>\n<!-- two-hyphens -->"));
    EXPECT_EQ(WhyRefused({"f.xml", noted}, {}), WhyRefused({"f.xml", before + Default()}, {}));
  }
  EXPECT_EQ(WithComment("\n<dds/>", "note"), "\n<!-- note -->\n<dds/>");
  EXPECT_EQ(WithComment("", "note"), "<!-- note -->\n");
}

TEST(ProfileEdit, AnEditThatSaysWhatIsThereChangesNoByte) {
  EXPECT_EQ(Edited(Default(), {{Owner::kReader, kReader, Policy::kDeadline, 150 * kMs},
                               {Owner::kReader, kReader, Policy::kReliability, kBestEffort},
                               {Owner::kReader, kReader, Policy::kDepth, 5}}),
            Default());
}

TEST(ProfileEdit, EveryShapeOfValueIsReadBackAsWritten) {
  const auto edited =
      Edited(Default(), {{Owner::kReader, kReader, Policy::kReliability, kReliable},
                         {Owner::kReader, kReader, Policy::kDepth, 17},
                         {Owner::kReader, kReader, Policy::kLease, 2500 * kMs},
                         {Owner::kParticipant, "giveway_participant", Policy::kMutationTries, 77}});
  EXPECT_EQ(Read(edited, Owner::kReader, kReader, Policy::kReliability), kReliable);
  EXPECT_EQ(Read(edited, Owner::kReader, kReader, Policy::kDepth), 17);
  EXPECT_EQ(Read(edited, Owner::kReader, kReader, Policy::kLease), 2500 * kMs);
  EXPECT_EQ(Read(edited, Owner::kParticipant, "giveway_participant", Policy::kMutationTries), 77);
  EXPECT_THAT(edited, HasSubstr("<!-- Requested: three periods; two beacons lost in a row"));
}

TEST(ProfileEdit, AnElementThatIsMissingIsMade) {
  const std::string bytes =
      "<profiles>\n"
      "  <data_reader profile_name='a'>\n"
      "    <qos>\n"
      "    </qos>\n"
      "  </data_reader>\n"
      "</profiles>\n";
  const auto edited = Edited(bytes, {{Owner::kReader, "a", Policy::kDeadline, 1200 * kMs}});
  EXPECT_THAT(edited, HasSubstr("    <qos>\n      <deadline><period><sec>1</sec><nanosec>200000000"
                                "</nanosec></period></deadline>\n    </qos>\n"));
}

TEST(ProfileEdit, AnEmptyElementIsFilled) {
  const auto edited = Edited("<profiles><data_writer profile_name=\"a\"/></profiles>",
                             {{Owner::kWriter, "a", Policy::kDepth, 3}});
  EXPECT_EQ(Read(edited, Owner::kWriter, "a", Policy::kDepth), 3);
}

TEST(ProfileEdit, WhatOnlyLooksLikeAnElementIsLeftAlone) {
  const std::string bytes =
      "<?xml version='1.0'?><!-- <profiles> > -->\n"
      "<dds note='a > b'><profiles><!-- <data_reader profile_name='a'> -->"
      "<data_reader profile_name='a'><topic><historyQos><!-- <depth>9</depth> -->"
      "<depth>4</depth></historyQos></topic></data_reader></profiles></dds>";
  std::string expected = bytes;
  expected.replace(expected.find("<depth>4"), 8, "<depth>8");
  EXPECT_EQ(Edited(bytes, {{Owner::kReader, "a", Policy::kDepth, 8}}), expected);
}

TEST(ProfileEdit, TheLastOfTwoElementsIsTheOneThatCounts) {
  const auto edited = Edited(
      "<profiles><data_reader profile_name='a'><topic><historyQos><depth>1</depth>"
      "<depth>2</depth></historyQos></topic></data_reader></profiles>",
      {{Owner::kReader, "a", Policy::kDepth, 8}});
  EXPECT_THAT(edited, HasSubstr("<depth>1</depth><depth>8</depth>"));
}

TEST(ProfileEdit, AMissingProfileAndBrokenXmlAreFindings) {
  const ProfileEdit edit{Owner::kWriter, "missing", Policy::kDepth, 3};
  EXPECT_EQ(Edit(Default(), "f.xml", {edit}).findings.at(0).rule, "missing_profile");
  EXPECT_EQ(Edit("<dds><profiles>", "f.xml", {edit}).findings.size(), 1U);
}

TEST(ProfileEdit, AnEditedShippedSetPassesTheCheck) {
  for (const auto& file : XmlFilesIn(GIVEWAY_QOS_SETS)) {
    const auto edited = Edited(BytesOf(file), {{Owner::kReader, kReader, Policy::kDepth, 6}});
    EXPECT_TRUE(Check({{file, edited}}, {}).empty()) << file;
  }
}

}  // namespace
}  // namespace giveway::qos
