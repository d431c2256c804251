// A packet that says its writer has asked the reader's filter already: the library then does not
// ask it, and keeps the sample. The packet filter drops such packets; in shared memory, which it
// does not see, what is read is held against the filter's rule once more.
#include <gmock/gmock.h>

#include <atomic>
#include <string>

#include "services/link/convert/convert.h"
#include "services/link/fastdds/packets_of_process.h"
#include "services/link/fastdds/profile_file.h"
#include "services/link/inbox/participant_of.h"
#include "services/link/observer_link.h"
#include "services/link/participant.h"
#include "services/link/world_link.h"
#include "tests/link/fleet.h"

namespace giveway::test {
namespace {

using link::dds::DataWriter;
using link::dds::IContentFilter;
using link::dds::IContentFilterFactory;

constexpr VehicleId kSeven{7};
constexpr SessionId kSession{1, 2, 3, 4};
constexpr double kLie_s = 77;

link::LinkOptions OptionsInSharedMemory(const DomainLock& domain) {
  link::LinkOptions options = OptionsIn(domain);
  options.qos = link::ReadProfileFile(GIVEWAY_QOS_SETS "/same_host.xml");
  return options;
}

class Unnamed final : public link::DiscoveryListener {
 public:
  void OnWriter(Change, const link::rtps::GUID_t&, const std::vector<std::string>&) override {}
};

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wnon-virtual-dtor"

// Says of every sample that it passes.
class PassesAll final : public IContentFilterFactory {
 public:
  link::ReturnCode create_content_filter(const char*, const char*, const link::dds::TopicDataType*,
                                         const char*, const ParameterSeq&,
                                         IContentFilter*& filter) override {
    filter = &filter_;
    return link::ReturnCode{};
  }
  link::ReturnCode delete_content_filter(const char*, IContentFilter*) override {
    return link::ReturnCode{};
  }
  std::uint32_t Asked() const { return filter_.asked; }

 private:
  struct Filter final : IContentFilter {
    bool evaluate(const SerializedPayload&, const FilterSampleInfo&, const GUID_t&) const override {
      ++asked;
      return true;
    }
    mutable std::atomic<std::uint32_t> asked{0};
  };
  Filter filter_;
};

#pragma GCC diagnostic pop

// A writer whose samples are marked as those that pass the filter of the one reader there is.
template <typename Wire>
class Marked {
 public:
  Marked(const link::LinkOptions& options, const std::string& partition)
      : participant_(options, "intruder", listener_) {
    auto plain = participant_.MakeWriter<Wire>(partition);
    EXPECT_TRUE(Eventually([&] { return plain.HasReader(); }));
    link::dds::PublicationMatchedStatus matched;
    plain.Entity().get_publication_matched_status(matched);
    const std::string filter_class =
        "giveway " + link::ParticipantName(link::GuidOf(matched.last_subscription_handle));
    auto& own = const_cast<link::dds::DomainParticipant&>(
        *plain.Entity().get_publisher()->get_participant());
    EXPECT_TRUE(link::Ok(own.register_content_filter_factory(filter_class.c_str(), &passes_)));
    link::dds::PublisherQos publisher_qos;
    publisher_qos.partition().push_back(partition.c_str());
    link::dds::DataWriterQos qos = plain.Entity().get_qos();
    qos.writer_resource_limits().reader_filters_allocation.maximum = 32;
    writer_ =
        own.create_publisher(publisher_qos)->create_datawriter(plain.Entity().get_topic(), qos);
    EXPECT_TRUE(Eventually([&] {
      link::dds::PublicationMatchedStatus status;
      writer_->get_publication_matched_status(status);
      return status.current_count > 0;
    }));
  }
  // True once samples are marked.
  bool Write(Wire sample) {
    writer_->write(&sample);
    return passes_.Asked() > 3;
  }

 private:
  PassesAll passes_;  // the library asks it until the participant is gone
  Unnamed listener_;
  link::Participant participant_;
  DataWriter* writer_ = nullptr;
};

TEST(MarkedAsFiltered, ASampleOfAnotherWorldIsNotObserved) {
  const DomainLock domain;
  link::WorldLink world(OptionsInSharedMemory(domain));
  link::ObserverLink observer(OptionsInSharedMemory(domain));
  std::uint32_t tick = 0;
  const auto next = [&] {
    Truth truth;
    truth.vehicle = kSeven;
    truth.epoch = WorldEpoch{1};
    truth.tick = Tick{++tick};
    return truth;
  };
  ASSERT_TRUE(Eventually([&] {
    world.SendTruth(next());
    return !observer.Take().truths.empty();
  }));
  Marked<wire::Truth> intruder(OptionsInSharedMemory(domain), link::kWorldPartition);
  std::uint32_t refused = 0;
  ASSERT_TRUE(Eventually([&] {
    world.SendTruth(next());
    Truth lie = next();
    lie.vehicle = VehicleId{8};
    lie.time_s = kLie_s;
    const bool marked = intruder.Write(link::ToWire(lie));
    const link::Observed observed = observer.Take();
    for (const Truth& truth : observed.truths) EXPECT_NE(truth.time_s, kLie_s);
    refused += observed.refused;
    return marked && refused > 10;
  }));
}

TEST(MarkedAsFiltered, AStatusOfAnotherThanTheFirstIsNotObserved) {
  const DomainLock domain;
  link::VehicleLink vehicle(OptionsInSharedMemory(domain));
  vehicle.Open(kSeven);
  link::ObserverLink observer(OptionsInSharedMemory(domain));
  VehicleStatus status;
  status.vehicle = kSeven;
  ASSERT_TRUE(Eventually([&] {
    vehicle.SendStatus(status);
    return !observer.Take().statuses.empty();
  }));
  Marked<wire::Status> intruder(OptionsInSharedMemory(domain), "v7");
  std::uint32_t refused = 0;
  ASSERT_TRUE(Eventually([&] {
    vehicle.SendStatus(status);
    VehicleStatus lie = status;
    lie.peers_heard = 99;
    const bool marked = intruder.Write(link::ToWire(lie));
    const link::Observed observed = observer.Take();
    for (const VehicleStatus& one : observed.statuses) EXPECT_NE(one.peers_heard, 99U);
    refused += observed.refused;
    return marked && refused > 10;
  }));
}

TEST(MarkedAsFiltered, ACommandOfAnotherThanTheOwnerMovesNoWheels) {
  const DomainLock domain;
  link::WorldLink world(OptionsInSharedMemory(domain));
  link::VehicleLink vehicle(OptionsInSharedMemory(domain));
  vehicle.SendJoin({kSession, kSeven});
  ASSERT_TRUE(Eventually([&] { return !world.TakeJoins().empty(); }));
  RosterEntry entry;
  entry.session = kSession;
  entry.vehicle = kSeven;
  entry.accepted = true;
  entry.epoch = WorldEpoch{1};
  world.SendRoster(entry);
  Marked<wire::MotorCommand> intruder(OptionsInSharedMemory(domain), "v7");
  ASSERT_TRUE(Eventually([&] {
    MotorCommand lie;
    lie.vehicle = kSeven;
    const bool marked = intruder.Write(link::ToWire(lie));
    EXPECT_TRUE(world.TakeCommands().empty());
    return marked && world.Counters().commands_strangers > 10;
  }));
}

TEST(MarkedAsFiltered, ASampleOverUdpDoesNotReachTheLibrary) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  link::ObserverLink observer(OptionsIn(domain));
  Marked<wire::Truth> intruder(OptionsIn(domain), link::kWorldPartition);
  const auto dropped = [] { return link::PacketsOfProcess().Of(PacketDrop::kMalformed); };
  const std::uint64_t before = dropped();
  ASSERT_TRUE(Eventually([&] {
    Truth lie;
    lie.vehicle = kSeven;
    lie.epoch = WorldEpoch{1};
    const bool marked = intruder.Write(link::ToWire(lie));
    return marked && dropped() > before + 10;
  }));
}

// An expression of a stranger's reader would be parsed by every writer, and asked for each sample.
TEST(Writers, FilterForNoReader) {
  const DomainLock domain;
  Unnamed listener;
  link::Participant participant(OptionsIn(domain), "any", listener);
  const auto writer = participant.MakeWriter<wire::Beacon>("main/v7");
  EXPECT_EQ(writer.Entity().get_qos().writer_resource_limits().reader_filters_allocation.maximum,
            0U);
}

}  // namespace
}  // namespace giveway::test
