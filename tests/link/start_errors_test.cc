// What a participant that cannot be made says. Each in a process of its own, as a service would be:
// the library keeps the profiles it loaded once for the whole process.
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "services/link/fastdds/fastdds_version.h"
#include "services/link/fastdds/profile_file.h"
#include "services/link/qos_trial.h"
#include "services/link/resolved_qos.h"
#include "tests/link/fleet.h"

namespace giveway::test {
namespace {

using ::testing::ExitedWithCode;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::ThrowsMessage;

// As a main does: the error on stderr, exit 2.
[[noreturn]] void Start(const link::LinkOptions& options) {
  try {
    link::VehicleLink vehicle(options);
    vehicle.Open(VehicleId{1});
  } catch (const link::LinkError& error) {
    std::fprintf(stderr, "start error: %s\n", error.what());
    std::exit(2);
  }
  std::exit(0);
}

[[noreturn]] void Try(const link::LinkOptions& options) {
  try {
    link::TryQos(options);
  } catch (const link::LinkError& error) {
    std::fprintf(stderr, "start error: %s\n", error.what());
    std::exit(2);
  }
  std::exit(0);
}

// Its exit code is the depth that the library reads.
[[noreturn]] void ExitWithDepth(const link::LinkOptions& options, const std::string& profile) {
  for (const link::ResolvedEntity& entity : link::ResolveQos(options)) {
    if (entity.profile != profile) continue;
    for (const link::ResolvedValue& value : entity.values) {
      if (value.policy == "depth") std::exit(static_cast<int>(value.number));
    }
  }
  std::exit(0);
}

class StartErrors : public ::testing::Test {
 protected:
  StartErrors() : options_(OptionsIn(domain_)) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    folder_ = std::filesystem::temp_directory_path() /
              ("giveway-start-errors-" + std::to_string(options_.domain));
    std::filesystem::create_directories(folder_);
  }
  ~StartErrors() override { std::filesystem::remove_all(folder_); }

  static QosProfiles Named(const std::string& text) { return {"a/qos.xml", text}; }
  QosProfiles DefaultWith(const std::string& what, const std::string& instead) {
    std::string text = default_;
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return Named(text.replace(at, what.size(), instead));
  }

  DomainLock domain_;
  link::LinkOptions options_;
  const std::string default_ = options_.qos.text;
  std::filesystem::path folder_;
};

TEST_F(StartErrors, AreNoneWithTheDefaultProfiles) {
  EXPECT_EXIT(Start(options_), ExitedWithCode(0), "^$");
}

TEST_F(StartErrors, NameAFileThatIsNotThere) {
  EXPECT_THAT([] { link::ReadProfileFile("/nowhere/qos.xml"); },
              ThrowsMessage<link::LinkError>(
                  MatchesRegex("QoS file /nowhere/qos.xml: does not exist; give .*default.xml")));
}

TEST_F(StartErrors, NameAFolderGivenAsFile) {
  EXPECT_THAT([this] { link::ReadProfileFile(folder_); },
              ThrowsMessage<link::LinkError>(HasSubstr("is not a file")));
}

// Regression: an exception of the library of streams ended the process.
TEST_F(StartErrors, NameAFileThatCannotBeReadToItsEnd) {
  EXPECT_THAT(
      [] { link::ReadProfileFile("/proc/self/mem"); },
      ThrowsMessage<link::LinkError>(HasSubstr("/proc/self/mem: cannot be read to its end")));
}

TEST_F(StartErrors, RefuseAnEmptyAndABinaryFile) {
  options_.qos = Named("");
  EXPECT_EXIT(Start(options_), ExitedWithCode(2), "start error: .*qos.xml: the library refuses it");
  options_.qos = Named(std::string("\0\1\2\377\376 ELF", 9));
  EXPECT_EXIT(Start(options_), ExitedWithCode(2), "start error: .*qos.xml: the library refuses it");
}

TEST_F(StartErrors, RefuseMalformedXml) {
  options_.qos = Named(default_.substr(0, 3000));
  EXPECT_EXIT(Start(options_), ExitedWithCode(2), "start error: .*qos.xml: the library refuses it");
}

TEST_F(StartErrors, QuoteTheLibraryOnAnUnknownElement) {
  options_.qos = DefaultWith("<deadline>", "<deadlines></deadlines><deadline>");
  EXPECT_EXIT(Start(options_), ExitedWithCode(2),
              "start error: .*the library refuses it.*\n.*Fast DDS: .*deadlines");
}

TEST_F(StartErrors, NameAProfileThatIsMissing) {
  options_.qos = DefaultWith("fleet_beacon_writer", "fleet_bacon_writer");
  EXPECT_EXIT(Start(options_), ExitedWithCode(2),
              "start error: QoS file .*qos.xml: has no profile \"fleet_beacon_writer\"; .*copy");
  options_.qos = DefaultWith("giveway_participant", "participant");
  EXPECT_EXIT(Start(options_), ExitedWithCode(2),
              "start error: .*has no profile \"giveway_participant\"");
}

TEST_F(StartErrors, RefuseTheBuiltinTransports) {
  options_.qos = DefaultWith("<useBuiltinTransports>false", "<useBuiltinTransports>true");
  EXPECT_EXIT(Start(options_), ExitedWithCode(2), "start error: .*useBuiltinTransports");
}

// What passes through shared memory no impairment would touch: a run would be called impaired and
// hear everything.
TEST_F(StartErrors, RefuseAnImpairmentBesideSharedMemory) {
  options_.qos = link::ReadProfileFile(GIVEWAY_QOS_SETS "/same_host.xml");
  options_.impairment.rules = {{.loss = 0.5}};
  options_.impairment.seed = 1;
  EXPECT_EXIT(Start(options_), ExitedWithCode(2), "start error: .*names shared memory");
}

// No rule calls it an error, and the library makes no endpoint of ours with it.
TEST_F(StartErrors, AreFoundByATrialOfTheSet) {
  EXPECT_EXIT(Try(options_), ExitedWithCode(0), "^$");
  const std::string profile = "profile_name=\"fleet_beacon_writer\"";
  std::string text = default_;
  const std::size_t at = text.find("<kind>OFF", text.find("<data_sharing>", text.find(profile)));
  options_.qos = Named(text.replace(at, 9, "<kind>ON"));
  EXPECT_EXIT(Try(options_), ExitedWithCode(2), "start error: .*fleet_beacon_writer");
}

TEST_F(StartErrors, AreNoneForNumbersThatTheRulesRead) {
  for (const char* four : {" 4 ", "\n  4\n", "+4", "4.0", "0x4", "4ms"}) {
    options_.qos = DefaultWith("<depth>1<", std::string("<depth>") + four + "<");
    EXPECT_EXIT(ExitWithDepth(options_, "fleet_beacon_writer"), ExitedWithCode(4), "^$") << four;
  }
}

// As the rule buffer_above_limit says.
TEST_F(StartErrors, OfABufferOfMinusOneAreThoseOfFastDds3Alone) {
  options_.qos = DefaultWith(">1048576<", ">-1<");
  EXPECT_EXIT(Start(options_), ExitedWithCode(link::kLibraryMajor < 3 ? 0 : 2), "");
}

TEST_F(StartErrors, NameTheInterfacesThereAre) {
  options_.interface = "eth99";
  EXPECT_EXIT(Start(options_), ExitedWithCode(2),
              "start error: interface \"eth99\" .*lo \\(127.0.0.1\\)");
}

TEST_F(StartErrors, RefuseADomainOrAreaOutOfRange) {
  for (const std::uint32_t wrong : {0U, 100U, 4000000000U}) {
    options_.domain = wrong;
    EXPECT_EXIT(Start(options_), ExitedWithCode(2), "start error: domain .*must be 1 to 99");
  }
  options_ = OptionsIn(domain_);
  for (const char* wrong : {"", "Main", "a/b", "*", "a b"}) {
    options_.area = wrong;
    EXPECT_EXIT(Start(options_), ExitedWithCode(2), "start error: area \".*must be");
  }
}

TEST_F(StartErrors, AreNoneWhereStrayProfilesLieAboutOrAreNamedByTheEnvironment) {
  // Heard, it would take the names of our profiles, and the second ones would be refused.
  std::ofstream(folder_ / "DEFAULT_FASTRTPS_PROFILES.xml") << default_;
  std::ofstream(folder_ / "DEFAULT_FASTDDS_PROFILES.xml") << default_;
  const std::string stray = folder_ / "stray.xml";
  std::ofstream(stray) << "<broken";
  EXPECT_EXIT(
      {
        std::filesystem::current_path(folder_);
        setenv("FASTRTPS_DEFAULT_PROFILES_FILE", stray.c_str(), 1);
        setenv("ROS_DISCOVERY_SERVER", "127.0.0.1:11811", 1);
        Start(options_);
      },
      ExitedWithCode(0), "^$");
}

}  // namespace
}  // namespace giveway::test
