#include <gmock/gmock.h>

#include "services/qos/order_check.h"
#include "services/qos/profile_check.h"
#include "tests/unit/qos/qos_files.h"

namespace giveway::qos {
namespace {

XmlElement Root(const std::string& text) { return *ReadXml(text, "qos.xml").root; }

std::string Default() { return BytesOf(std::filesystem::path(GIVEWAY_QOS_SETS) / "default.xml"); }

// The default with `text` put in front of the first `before`.
std::string With(const std::string& text, const std::string& before) {
  std::string set = Default();
  return set.insert(set.find(before), text);
}

std::vector<std::string> RefusedRules(const std::string& wanted, const std::string& running) {
  std::vector<std::string> rules;
  for (const Finding& finding : CheckOrder(Root(wanted), Root(running), "order.xml")) {
    EXPECT_EQ(finding.severity, Severity::kError);
    EXPECT_GT(finding.place.line, 0);
    rules.push_back(finding.rule + " " + finding.subject);
  }
  return rules;
}

TEST(Orders, MayBringEveryShippedSet) {
  for (const auto& file : XmlFilesIn(GIVEWAY_QOS_SETS)) {
    const std::string set = BytesOf(file);
    EXPECT_THAT(RefusedRules(set, set), ::testing::IsEmpty()) << file;
    // The servers of this one are addresses of its own.
    if (file.stem() == "wan_discovery_server") continue;
    EXPECT_THAT(RefusedRules(set, Default()), ::testing::IsEmpty()) << file;
  }
}

TEST(Orders, MakeNoLibraryWriteFilesOrSendElsewhere) {
  struct Case {
    const char *text, *before, *element;
  };
  constexpr const char* kShm =
      "<transport_descriptor><transport_id>shm</transport_id><type>SHM</type><rtps_dump_file>/etc/x"
      "</rtps_dump_file></transport_descriptor>";
  for (const Case& one : {
           Case{"<log><use_default>FALSE</use_default></log>", "<profiles>", "<log>"},
           Case{"<types/>", "<profiles>", "<types>"},
           Case{kShm, "</transport_descriptors>", "<rtps_dump_file>"},
           Case{"<propertiesPolicy/>", "<useBuiltinTransports>", "<propertiesPolicy>"},
           Case{"<userData/>", "<useBuiltinTransports>", "<userData>"},
           Case{"<allocation/>", "<useBuiltinTransports>", "<allocation>"},
           Case{"<prefix>1</prefix>", "<useBuiltinTransports>", "<prefix>"},
           Case{"<initialPeersList/>", "<discovery_config>", "<initialPeersList>"},
           Case{"<discoveryServersList/>", "<leaseDuration>", "<discoveryServersList>"},
           Case{"<staticEndpointXMLFilename>/x</staticEndpointXMLFilename>", "<leaseDuration>",
                "<staticEndpointXMLFilename>"},
           Case{"<interfaceWhiteList/>", "<TTL>", "<interfaceWhiteList>"},
           Case{"<output_port>1</output_port>", "<TTL>", "<output_port>"},
           Case{"<propertiesPolicy/>", "<topic>", "<propertiesPolicy>"},
           Case{"<remoteLocatorList/>", "<topic>", "<remoteLocatorList>"},
           Case{"<shared_dir>/etc</shared_dir>", "</data_sharing>", "<shared_dir>"},
           Case{"<unheard_of/>", "<topic>", "<unheard_of>"},
       }) {
    const std::string set = With(one.text, one.before);
    EXPECT_THAT(RefusedRules(set, Default()),
                ::testing::Contains(std::string("not_by_order ") + one.element))
        << one.text;
    // A process that already runs with it may keep it.
    EXPECT_THAT(RefusedRules(set, set), ::testing::IsEmpty()) << one.text;
  }
}

TEST(Orders, ReserveNoMoreThanSoMuch) {
  const std::string set =
      With("<allocated_samples>2000000000</allocated_samples>", "<max_samples>");
  EXPECT_THAT(RefusedRules(set, Default()),
              ::testing::ElementsAre("too_large_for_order <allocated_samples>"));
}

TEST(Orders, AreLookedAtWithoutTheRootElementToo) {
  constexpr const char* kBare =
      "<profiles><participant "
      "profile_name='p'><rtps><name>x</name></rtps></participant></profiles>";
  EXPECT_THAT(RefusedRules(kBare, Default()), ::testing::ElementsAre("not_by_order <name>"));
}

TEST(SetsAtStart, AreRefusedWithFileLineFieldValueAndRemedy) {
  EXPECT_EQ(WhyRefused({"default.xml", Default()}, {}), "");
  std::string set = Default();
  const std::string period = "<nanosec>150000000</nanosec>";
  set.replace(set.find(period), period.size(), "<nanosec>1500000000</nanosec>");
  EXPECT_THAT(WhyRefused({"mine.xml", set}, {}),
              ::testing::MatchesRegex("QoS file mine.xml:[0-9]+: <nanosec>: \"1500000000\": .*hangs"
                                      ".*; write nanoseconds from 0 to 999999999.*"));
}

}  // namespace
}  // namespace giveway::qos
