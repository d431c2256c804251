#include "services/link/resolved_qos.h"

#include <memory>

#include "services/link/fastdds/library_log.h"
#include "services/link/fastdds/profiles.h"
#include "services/link/participant.h"
#include "services/link/resolved_values.h"

namespace giveway::link {
namespace {

// A participant that was never enabled: it has no sockets and no threads, and answers questions.
class SilentParticipant {
 public:
  explicit SilentParticipant(const LinkOptions& options) {
    LoadProfiles(options.qos);
    qos_ = ParticipantQos(options, "giveway-qos");
    auto* factory = dds::DomainParticipantFactory::get_instance();
    dds::DomainParticipantFactoryQos before;
    factory->get_qos(before);
    dds::DomainParticipantFactoryQos silent = before;
    silent.entity_factory().autoenable_created_entities = false;
    factory->set_qos(silent);
    participant_.reset(
        factory->create_participant(options.domain, qos_, nullptr, dds::StatusMask::none()));
    factory->set_qos(before);
    if (participant_ == nullptr) {
      throw LinkError("Fast DDS did not make a participant of " + options.qos.name +
                      LibraryComplaints());
    }
    publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  }

  ResolvedEntity Itself() const { return {"giveway_participant", "", ValuesOf(qos_)}; }

  template <typename Wire>
  void Append(std::int32_t depth, std::vector<ResolvedEntity>& to) {
    using Topic = TopicOf<Wire>;
    to.push_back({Topic::kWriter, Topic::kName,
                  ValuesOf(WriterQos(*publisher_, Topic::kWriter, depth), publisher_->get_qos())});
    to.push_back(
        {Topic::kReader, Topic::kName,
         ValuesOf(ReaderQos(*subscriber_, Topic::kReader, depth), subscriber_->get_qos())});
  }

 private:
  struct DeleteAll {
    void operator()(dds::DomainParticipant* participant) const {
      participant->delete_contained_entities();
      dds::DomainParticipantFactory::get_instance()->delete_participant(participant);
    }
  };

  dds::DomainParticipantQos qos_;
  std::unique_ptr<dds::DomainParticipant, DeleteAll> participant_;
  dds::Publisher* publisher_ = nullptr;    // the participant's
  dds::Subscriber* subscriber_ = nullptr;  // the participant's
};

}  // namespace

std::vector<ResolvedEntity> ResolveQos(const LinkOptions& options) {
  SilentParticipant participant(options);
  std::vector<ResolvedEntity> resolved = {participant.Itself()};
  constexpr std::int32_t kOfProfile = Participant::kProfileDepth;
  participant.Append<wire::Beacon>(kOfProfile, resolved);
  participant.Append<wire::MotorCommand>(kOfProfile, resolved);
  participant.Append<wire::Status>(kOfProfile, resolved);
  participant.Append<wire::Order>(kOfProfile, resolved);
  participant.Append<wire::Answer>(kOfProfile, resolved);
  participant.Append<wire::Join>(kOfProfile, resolved);
  participant.Append<wire::RangeScan>(kOfProfile, resolved);
  participant.Append<wire::RadarScan>(kOfProfile, resolved);
  participant.Append<wire::LidarScan>(kOfProfile, resolved);
  participant.Append<wire::CameraScan>(kOfProfile, resolved);
  participant.Append<wire::PoseFix>(kOfProfile, resolved);
  participant.Append<wire::SignalState>(kOfProfile, resolved);
  participant.Append<wire::Roster>(kOfProfile, resolved);
  participant.Append<wire::Truth>(kOfProfile, resolved);
  participant.Append<wire::Event>(EventDepth(options.fleet_size), resolved);
  participant.Append<wire::Figures>(kOfProfile, resolved);
  return resolved;
}

}  // namespace giveway::link
