#include <gmock/gmock.h>

#include "services/qos/profile_check.h"
#include "services/qos/profile_set.h"
#include "services/qos/xml_tree.h"
#include "tests/unit/qos/qos_files.h"

namespace giveway::qos {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::IsEmpty;

Findings CheckBytes(const std::string& bytes) { return Check({{"qos.xml", bytes}}, {}); }

auto OfRule(const std::string& rule) { return Contains(Field(&Finding::rule, rule)); }

TEST(Check, FindsNothingInTheShippedSets) {
  for (const auto& file : XmlFilesIn(GIVEWAY_QOS_SETS)) {
    for (const std::int64_t vehicles : {2, 8, 50, 100}) {
      const Findings findings =
          Check({{file.filename(), BytesOf(file)}}, Deployment{.vehicles = vehicles});
      EXPECT_THAT(findings, IsEmpty())
          << file << " with " << vehicles << " vehicles: " << findings.front().rule << " at "
          << findings.front().place.line;
    }
  }
}

// The library re-arms a deadline for every vehicle that it ever received, and the world checks the
// age of commands by its own clock.
TEST(ShippedSets, ArmNoDeadlineAtTheWorldForTheCommandsOfVehicles) {
  for (const auto& file : XmlFilesIn(GIVEWAY_QOS_SETS)) {
    const XmlRead read = ReadXml(BytesOf(file), file.filename());
    ASSERT_TRUE(read.root.has_value()) << file;
    const ProfileSet set = ReadProfiles(*read.root, file.filename());
    const Profile* reader = set.Find(Owner::kReader, "fleet_motor_command_reader");
    ASSERT_NE(reader, nullptr) << file;
    EXPECT_EQ(reader->Number(Policy::kDeadline), kInfinite) << file;
  }
}

TEST(Check, RefusesAnEmptyFileABinaryOneAndOneTooLarge) {
  EXPECT_THAT(CheckBytes(""), OfRule("empty_file"));
  EXPECT_THAT(CheckBytes(" \n\t\n"), OfRule("empty_file"));
  EXPECT_THAT(CheckBytes(std::string("\177ELF\0\1\2", 7)), OfRule("not_text"));
  EXPECT_THAT(CheckBytes(std::string(10U << 20U, ' ') + "<dds/>"), OfRule("file_too_large"));
}

TEST(Check, RefusesAFileOfMoreElementsThanAPersonWrites) {
  std::string bytes = "<dds>";
  for (int i = 0; i < 200'000; ++i) bytes += "<a/>";
  EXPECT_THAT(CheckBytes(bytes + "</dds>"), OfRule("file_too_large"));
}

TEST(Check, RefusesNestingWithoutEndInsteadOfFollowingIt) {
  std::string bytes;
  for (int i = 0; i < 100'000; ++i) bytes += "<dds>";
  EXPECT_THAT(CheckBytes(bytes), OfRule("malformed_xml"));
}

TEST(Check, NamesTheLineOfTheElementThatIsNotClosed) {
  const Findings findings = CheckBytes("<dds>\n<profiles>\n</profile>\n</dds>\n");
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings.front().rule, "malformed_xml");
  EXPECT_EQ(findings.front().place.line, 2);
}

TEST(Check, StopsCountingAtANumberAPersonReads) {
  std::string bytes = "<dds><profiles>";
  for (int i = 0; i < 5000; ++i) bytes += "<data_writer profile_name=\"w\"/>";
  const Findings findings = CheckBytes(bytes + "</profiles></dds>");
  EXPECT_EQ(findings.size(), kMostFindings + 1);
  EXPECT_EQ(findings.back().rule, "more_findings");
  EXPECT_EQ(ExitCode(findings), 2);
}

TEST(Check, CountsAllThatIsNotShownOfAllFiles) {
  std::string wrong = "<dds><profiles>";
  for (int i = 0; i < 300; ++i) wrong += "<data_writer profile_name=\"w\"/>";
  wrong += "</profiles></dds>";
  const Findings one = Check({{"a.xml", wrong}}, Deployment{.complete = false});
  const Findings two = Check({{"a.xml", wrong}, {"b.xml", wrong}}, Deployment{.complete = false});
  const auto more = [](const Findings& findings) { return std::stoi(findings.back().values); };
  EXPECT_GT(more(one), 100);
  EXPECT_EQ(more(two), 2 * more(one) + static_cast<int>(kMostFindings));
}

// Each set is sound by itself.
TEST(Check, SaysWhichSetsNeverDiscoverEachOther) {
  const std::string good = BytesOf(std::string(GIVEWAY_QOS_SETS) + "/default.xml");
  const std::string client = BytesOf(std::string(GIVEWAY_QOS_SETS) + "/wan_discovery_server.xml");
  const auto with = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const std::string other_port =
      with(good, "<builtin>", "<port><portBase>8000</portBase></port><builtin>");
  const std::string other_server = with(client, "44.53.00", "44.53.01");
  const std::string other_address = with(client, ">127.0.0.1<", ">10.1.2.3<");
  const auto findings = [](const std::string& a, const std::string& b) {
    return Check({{"a.xml", a}, {"b.xml", b}}, {});
  };
  EXPECT_THAT(findings(good, good), IsEmpty());
  EXPECT_THAT(findings(client, client), IsEmpty());
  EXPECT_THAT(findings(good, client), OfRule("discovery_mismatch"));
  EXPECT_THAT(findings(good, other_port), OfRule("discovery_mismatch"));
  EXPECT_THAT(findings(client, other_server), OfRule("discovery_mismatch"));
  EXPECT_THAT(findings(client, other_address), OfRule("discovery_address"));
  EXPECT_EQ(ExitCode(findings(client, other_address)), 1);
}

TEST(Check, HoldsTheSegmentOfSharedMemoryAgainstItsMessagesAsTheLibraryDoes) {
  const auto with = [](const std::string& elements) {
    return Check(
        {{"qos.xml",
          "<dds><profiles><transport_descriptors><transport_descriptor><transport_id>shm"
          "</transport_id><type>SHM</type>" +
              elements + "</transport_descriptor></transport_descriptors></profiles></dds>"}},
        Deployment{.complete = false});
  };
  // 512 KiB, if it says nothing, or 0.
  const std::string large = "<maxMessageSize>1000000</maxMessageSize>";
  EXPECT_THAT(with(large), OfRule("segment_too_small"));
  EXPECT_THAT(with("<segment_size>0</segment_size>"), ::testing::Not(OfRule("segment_too_small")));
  EXPECT_THAT(with(large + "<segment_size>2000000</segment_size>"),
              ::testing::Not(OfRule("segment_too_small")));
}

TEST(Check, RefusesADurationThatIsInfiniteAndHasParts) {
  EXPECT_THAT(CheckBytes("<dds><profiles><data_writer profile_name='w'><qos><deadline><period>"
                         "DURATION_INFINITY<sec>1</sec></period></deadline></qos></data_writer>"
                         "</profiles></dds>"),
              OfRule("wrong_value"));
}

// Each set alone is complete and valid; only together do they starve a reader.
TEST(Check, HoldsTheWritersOfOneFileAgainstTheReadersOfAnother) {
  const std::string good = BytesOf(std::string(GIVEWAY_QOS_SETS) + "/default.xml");
  std::string other = good;
  for (std::size_t at; (at = other.find("150000000")) != std::string::npos;) {
    other.replace(at, 9, "120000000");
  }
  for (std::size_t at; (at = other.find(">100000000")) != std::string::npos;) {
    other.replace(at, 10, ">110000000");
  }
  std::string slow = good;
  for (std::size_t at; (at = slow.find(">100000000")) != std::string::npos;) {
    slow.replace(at, 10, ">140000000");
  }
  EXPECT_THAT(Check({{"other.xml", other}}, {}), IsEmpty());
  EXPECT_THAT(Check({{"slow.xml", slow}}, {}), IsEmpty());
  const Findings findings = Check({{"slow.xml", slow}, {"other.xml", other}}, {});
  EXPECT_THAT(findings, OfRule("deadline_mismatch"));
  for (const Finding& finding : findings) {
    EXPECT_EQ(finding.rule, "deadline_mismatch");
    EXPECT_EQ(finding.place.file, "other.xml");
  }
}

TEST(Check, GivesBothValuesOfAMismatchWithTheirLines) {
  const Findings findings = Check({{"qos.xml", R"(<dds><profiles>
<data_writer profile_name="fleet_beacon_writer"><qos>
  <deadline><period><nanosec>200000000</nanosec></period></deadline>
</qos></data_writer>
<data_reader profile_name="fleet_beacon_reader"><qos>
  <deadline><period><nanosec>150000000</nanosec></period></deadline>
</qos></data_reader></profiles></dds>)"}},
                                  Deployment{.complete = false});
  const auto found = std::ranges::find(findings, "deadline_mismatch", &Finding::rule);
  ASSERT_NE(found, findings.end());
  EXPECT_EQ(found->place.line, 6);
  EXPECT_EQ(found->values,
            "the writer offers 200 ms (line 3), the reader requests 150 ms (line 6)");
}

TEST(Check, ExitsCleanWithWarningsOrWithErrors) {
  EXPECT_EQ(ExitCode({}), 0);
  EXPECT_EQ(ExitCode({{.severity = Severity::kWarning}}), 1);
  EXPECT_EQ(ExitCode({{.severity = Severity::kWarning}, {.severity = Severity::kError}}), 2);
}

}  // namespace
}  // namespace giveway::qos
