// Every element in the tables of services/qos is one that the library accepts, and it accepts no
// other: each is put into a profile of its own and loaded, in the syntax of the installed release.
#include <gtest/gtest.h>

#include <cstdlib>

#include "services/link/fastdds/fastdds_version.h"
#include "services/link/fastdds/library_log.h"
#include "services/link/fastdds/profile_spelling.h"
#include "services/qos/profile_check.h"
#include "services/qos/schema.h"

namespace giveway::qos {
namespace {

using link::Ok;

std::string Element(const std::string& name, const std::string& inside) {
  return "<" + name + ">" + inside + "</" + name + ">";
}

// Something that may stand in an element, by what it holds.
std::string Sample(std::string_view parent, const ElementRule& rule) {
  if (parent == "udpv6" && rule.name == "address") return "::1";
  if (rule.name == "ignoreParticipantFlags") return "FILTER_DIFFERENT_HOST";
  if (rule.name == "prefix") return "44.53.00.5f.45.50.52.4f.53.49.4d.41";
  if (rule.name == "transport_id") return "elements_udp";
  switch (rule.content) {
    case Content::kWord:
      return std::string(rule.words.substr(0, rule.words.find(' ')));
    case Content::kDuration:
      return "<sec>1</sec>";
    case Content::kFlag:
      return "true";
    case Content::kText:
      return "127.0.0.1";
    default:
      return "1";
  }
}

// What the library requires besides an element.
std::string Companion(std::string_view parent, std::string_view name) {
  if (parent == "data_sharing" && name != "kind") return "<kind>OFF</kind>";
  if (parent == "participant" && name != "rtps") return "<rtps/>";
  return {};
}

class Elements : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    setenv("SKIP_DEFAULT_XML_FILE", "1", 1);
    link::TakeOverLibraryLog();
    ASSERT_TRUE(Loads(
        "<transport_descriptors><transport_descriptor><transport_id>elements_udp</transport_id>"
        "<type>UDPv4</type></transport_descriptor></transport_descriptors>"));
  }

  static bool Loads(const std::string& profiles) {
    const std::string text =
        link::InOwnSpelling("<dds><profiles>" + profiles + "</profiles></dds>");
    return Ok(link::dds::DomainParticipantFactory::get_instance()->load_XML_profiles_string(
        text.data(), text.size()));
  }

  // `before` and `after` are the tags around, outermost first; each profile needs a name of its
  // own.
  void TryAll(std::string_view parent, std::span<const ElementRule> rules,
              const std::string& before, const std::string& after) {
    for (const ElementRule& rule : rules) {
      const std::string name(rule.name);
      if (name == "propertiesPolicy" || name == "RemoteServer") continue;
      if (rule.content == Content::kOpaque) continue;
      if (rule.gone_in_3 && link::kLibraryMajor >= 3) {
        Try(before + Element(name, "") + after, name, false);
        continue;
      }
      if (rule.content == Content::kElements) {
        const std::string beside = Companion(parent, name);
        TryAll(rule.name, rule.children, before + beside + "<" + name + ">",
               "</" + name + ">" + after);
        continue;
      }
      Try(before + Companion(parent, name) + Element(name, Sample(parent, rule)) + after, name,
          true);
    }
    if (!rules.empty()) Try(before + "<unheard_of>1</unheard_of>" + after, "unheard_of", false);
  }

  void Try(std::string profile, const std::string& element, bool known) {
    const std::size_t at = profile.find("@");
    profile.replace(at, 1, "elements" + std::to_string(++count_));
    EXPECT_EQ(Loads(profile), known) << element << " in " << profile << link::LibraryComplaints();
  }

  int count_ = 0;
};

TEST_F(Elements, OfWritersAndReaders) {
  TryAll("data_writer", EndpointElements(true), "<data_writer profile_name='@'>", "</data_writer>");
  TryAll("data_reader", EndpointElements(false), "<data_reader profile_name='@'>",
         "</data_reader>");
  EXPECT_GT(count_, 80);
}

TEST_F(Elements, OfParticipants) {
  TryAll("participant", ParticipantElements(), "<participant profile_name='@'>", "</participant>");
  EXPECT_GT(count_, 40);
}

TEST_F(Elements, OfADiscoveryServer) {
  Try("<participant profile_name='@'><rtps><builtin><discovery_config><discoveryServersList>"
      "<RemoteServer prefix='44.53.00.5f.45.50.52.4f.53.49.4d.41'><!-- the first of them -->"
      "<metatrafficUnicastLocatorList><locator><udpv4><address>127.0.0.1</address></udpv4>"
      "</locator></metatrafficUnicastLocatorList></RemoteServer></discoveryServersList>"
      "</discovery_config></builtin></rtps></participant>",
      "discoveryServersList", true);
}

TEST_F(Elements, OfTransports) {
  for (const std::string type : {"UDPv4", "SHM"}) {
    for (const ElementRule& rule : TransportElements(type)) {
      const std::string name(rule.name);
      if (rule.content == Content::kOpaque || name == "transport_id" || name == "type") continue;
      std::string inside = Sample(type, rule);
      if (!rule.children.empty()) {
        inside =
            Element(std::string(rule.children.front().name), Sample(type, rule.children.front()));
      }
      Try("<transport_descriptors><transport_descriptor><transport_id>@</transport_id><type>" +
              type + "</type>" + Element(name, inside) +
              "</transport_descriptor></transport_descriptors>",
          name, true);
    }
  }
  EXPECT_GT(count_, 12);
}

}  // namespace
}  // namespace giveway::qos
