// What services/qos predicts of random profiles, against what the library does with them: whether a
// writer and a reader match, and whether an endpoint can be made at all. GIVEWAY_QOS_PAIRS says of
// how many.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "services/link/fastdds/profiles.h"
#include "services/link/participant.h"
#include "services/qos/profile_check.h"
#include "services/qos/request_offered.h"
#include "services/qos/xml_tree.h"
#include "tests/link/fleet.h"
#include "tests/link/random_qos.h"

namespace giveway::test {
namespace {

namespace dds = link::dds;

constexpr int kBatch = 250;  // pairs a pair of participants

int PairsAskedFor() {
  const char* asked = std::getenv("GIVEWAY_QOS_PAIRS");
  return asked == nullptr ? 1000 : std::atoi(asked);
}

qos::ProfileSet SetOf(const std::string& text) {
  const qos::XmlRead read = qos::ReadXml(text, "random.xml");
  EXPECT_TRUE(read.root.has_value());
  return qos::ReadProfiles(*read.root, "random.xml");
}

// A participant on loopback whose endpoints are made by profile name alone.
class Endpoints {
 public:
  explicit Endpoints(const link::LinkOptions& options) {
    link::LoadProfiles(options.qos);
    auto* factory = dds::DomainParticipantFactory::get_instance();
    participant_ =
        factory->create_participant(options.domain, link::ParticipantQos(options, "qos-pairs"),
                                    nullptr, dds::StatusMask::none());
    dds::TypeSupport type(new link::TopicOf<wire::Beacon>::Type);
    type.register_type(participant_);
    type_ = type.get_type_name();
    publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  }
  ~Endpoints() {
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  Endpoints(const Endpoints&) = delete;
  Endpoints& operator=(const Endpoints&) = delete;

  // Null where the library refuses the profile.
  dds::DataWriter* Writer(const std::string& name) {
    return publisher_->create_datawriter_with_profile(Topic(name), name + "_writer", nullptr,
                                                      dds::StatusMask::none());
  }
  dds::DataReader* Reader(const std::string& name) {
    return subscriber_->create_datareader_with_profile(Topic(name), name + "_reader", nullptr,
                                                       dds::StatusMask::none());
  }

 private:
  dds::Topic* Topic(const std::string& name) {
    if (auto* known = participant_->lookup_topicdescription(name)) {
      return dynamic_cast<dds::Topic*>(known);
    }
    return participant_->create_topic(name, type_, dds::TOPIC_QOS_DEFAULT);
  }

  dds::DomainParticipant* participant_ = nullptr;
  dds::Publisher* publisher_ = nullptr;
  dds::Subscriber* subscriber_ = nullptr;
  std::string type_;
};

struct MadePair {
  std::string name;
  dds::DataWriter* writer = nullptr;
  dds::DataReader* reader = nullptr;
  bool offered_enough = false;
};

// Some of what 2.9 refuses 3.1 makes.
bool Refuses(const std::string& consequence) {
  return consequence.starts_with("The library refuses") ||
         (link::kLibraryMajor == 2 && consequence.find("2.9 refuses") != std::string::npos);
}

enum class Seen { kNothing, kMatch, kMismatch };

// Both outcomes show themselves: neither is concluded from silence.
Seen Observe(const MadePair& pair) {
  dds::PublicationMatchedStatus written;
  dds::SubscriptionMatchedStatus read;
  pair.writer->get_publication_matched_status(written);
  pair.reader->get_subscription_matched_status(read);
  if (written.total_count > 0 && read.total_count > 0) return Seen::kMatch;
  dds::OfferedIncompatibleQosStatus offered;
  dds::RequestedIncompatibleQosStatus requested;
  pair.writer->get_offered_incompatible_qos_status(offered);
  pair.reader->get_requested_incompatible_qos_status(requested);
  if (offered.total_count > 0 && requested.total_count > 0) return Seen::kMismatch;
  return Seen::kNothing;
}

class QosPrediction : public ::testing::Test {
 protected:
  QosPrediction() : options_(OptionsIn(domain_)) { link::LoadProfiles(options_.qos); }

  static void Load(const std::string& text) {
    ASSERT_TRUE(link::Ok(dds::DomainParticipantFactory::get_instance()->load_XML_profiles_string(
        text.data(), text.size())));
  }

  // Counts the pairs that match.
  int TryBatch(int first, int count, Random* random) {
    std::string profiles;
    for (int i = first; i < first + count; ++i) {
      profiles += RandomPair("pair" + std::to_string(i), random);
    }
    const std::string text = AsFile(profiles);
    Load(text);
    const qos::ProfileSet set = SetOf(text);
    Endpoints writing(options_);
    Endpoints reading(options_);
    std::vector<MadePair> pairs;
    int matching = 0;
    for (int i = first; i < first + count; ++i) {
      const std::string name = "pair" + std::to_string(i);
      pairs.push_back({name, writing.Writer(name), reading.Reader(name),
                       qos::WillMatch(*set.Find(qos::Owner::kWriter, name + "_writer"),
                                      *set.Find(qos::Owner::kReader, name + "_reader"))});
      matching += pairs.back().offered_enough ? 1 : 0;
    }
    Compare(pairs);
    return matching;
  }

  static void Compare(const std::vector<MadePair>& pairs) {
    for (const MadePair& pair : pairs) {
      ASSERT_TRUE(pair.writer != nullptr && pair.reader != nullptr) << pair.name;
    }
    EXPECT_TRUE(Eventually(
        [&] {
          return std::ranges::none_of(
              pairs, [](const MadePair& pair) { return Observe(pair) == Seen::kNothing; });
        },
        std::chrono::seconds(60)));
    for (const MadePair& pair : pairs) {
      EXPECT_EQ(Observe(pair), pair.offered_enough ? Seen::kMatch : Seen::kMismatch) << pair.name;
    }
  }

  DomainLock domain_;
  link::LinkOptions options_;
};

TEST_F(QosPrediction, OfMatchOrNoMatchIsWhatTheLibraryDoes) {
  Random random(1, 0);
  const int asked = PairsAskedFor();
  int matching = 0;
  for (int first = 0; first < asked; first += kBatch) {
    matching += TryBatch(first, std::min(kBatch, asked - first), &random);
  }
  // Else one half of the prediction was hardly tried.
  EXPECT_GT(matching, asked / 5);
  EXPECT_LT(matching, asked * 4 / 5);
  RecordProperty("matching", matching);
}

TEST_F(QosPrediction, OfWhatCannotBeMadeIsWhatTheLibraryRefuses) {
  constexpr int kEndpoints = 200;
  Random random(2, 0);
  Endpoints endpoints(options_);
  int refused = 0;
  for (int i = 0; i < kEndpoints; ++i) {
    const std::string name = "limits" + std::to_string(i);
    const std::string text = AsFile(RandomLimits(name, &random));
    Load(text);
    const qos::Findings findings =
        qos::Check({{"random.xml", text}}, qos::Deployment{.complete = false});
    const auto predicted = [&](const std::string& profile) {
      return std::ranges::none_of(findings, [&](const qos::Finding& finding) {
        return finding.subject == profile && Refuses(finding.consequence);
      });
    };
    EXPECT_EQ(endpoints.Writer(name) != nullptr, predicted(name + "_writer")) << text;
    EXPECT_EQ(endpoints.Reader(name) != nullptr, predicted(name + "_reader")) << text;
    refused += predicted(name + "_writer") ? 0 : 1;
  }
  EXPECT_GT(refused, kEndpoints / 5);
  EXPECT_LT(refused, kEndpoints * 9 / 10);
}

}  // namespace
}  // namespace giveway::test
