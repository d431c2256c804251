// One DDS participant and every entity in it. Entities are made by profile name; code adds only
// what follows from the options: partition, transport whitelist, history depth, announcement
// period.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "services/link/fastdds/endpoint.h"
#include "services/link/fastdds/link_options.h"
#include "services/link/fastdds/shared_memory_watch.h"
#include "services/link/fastdds/topics.h"
#include "services/link/inbox/unfit_endpoints.h"
#include "services/link/sample_filter.h"
#include "services/types/admin.h"
#include "services/types/ids.h"

namespace giveway::link {

class Impairer;

class Participant {
 public:
  // Takes the depth of a history from the profile.
  static constexpr std::int32_t kProfileDepth = 0;

  // The endpoints of others: kept for TakeUnfit or TakeFound, which is called again and again, or
  // not looked at.
  enum class Endpoints : std::uint8_t { kIgnored, kJudged };

  // `discovery` is called from the first moment and must outlive this. Throws LinkError.
  Participant(const LinkOptions& options, const std::string& name, DiscoveryListener& discovery,
              Endpoints of_others = Endpoints::kIgnored);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  // Each endpoint has a Publisher or Subscriber of its own, because that is what carries the
  // partition. Of a writer it may be empty: the default one, which no wildcard matches. Throws
  // LinkError.
  template <typename Wire>
  Writer<Wire> MakeWriter(const std::string& partition, std::int32_t depth = kProfileDepth) {
    return Writer<Wire>(MakeWriter(MakeTopic<Wire>(), TopicOf<Wire>::kWriter, partition, depth));
  }
  // `listener`, if any, hears the statuses of `mask`; it and `filter` must outlive this.
  template <typename Wire>
  Reader<Wire> MakeReader(const std::string& partition, std::int32_t depth = kProfileDepth,
                          dds::DataReaderListener* listener = nullptr,
                          const dds::StatusMask& mask = dds::StatusMask::none(),
                          SampleFilter* filter = nullptr) {
    return Reader<Wire>(MakeReader(MakeTopic<Wire>(), TopicOf<Wire>::kReader, partition, depth,
                                   listener, mask, {filter, TopicOf<Wire>::kKeyNumbers}));
  }
  template <typename Wire>
  Reader<Wire> MakeReader(const std::string& partition, SampleFilter* filter) {
    return MakeReader<Wire>(partition, kProfileDepth, nullptr, dds::StatusMask::none(), filter);
  }
  // A writer for readers outside the fleet, whose topic, type and QoS others have defined; in the
  // default partition. Throws LinkError.
  dds::DataWriter& MakeForeignWriter(const dds::TypeSupport& type, const std::string& topic,
                                     const dds::DataWriterQos& qos);
  // From now on every topic is another one, that no endpoint of the fleet has.
  void StandApart() { topic_prefix_ = "qos-trial/"; }
  // Deletes a writer made here, and its publisher. What is left goes with the participant.
  void Delete(dds::DataWriter& writer);

  // Every value of the endpoints there are now, as the library has it; of those of one profile and
  // the same values the first only.
  std::vector<LiveValue> LiveQos() const;
  // Gives the endpoints of a profile another deadline while they run, and those that are made of it
  // later. False if the library refused it for one of them: then later ones have the profile's.
  bool SetDeadline(const std::string& profile, const Duration& deadline);

  const rtps::GuidPrefix_t& Prefix() const { return participant_->guid().guidPrefix; }
  // The same in words: "010f45d2a3b1000001000000".
  std::string PrefixText() const;
  // One sentence while this participant is a client whose servers have not answered; else empty.
  std::string WhyNoPeerIsFound() const;
  // Whether its shared memory was deleted: participants that start later do not receive it, unless
  // they have none themselves. Or was replaced before it started: see SharedMemoryWatch. Looks at
  // most once a second; false where it has none.
  bool SharedMemoryIsGone();
  // Of endpoints found about a second ago, those that do not match one of ours, and why.
  std::vector<std::string> TakeUnfit(SteadyTime now);
  // The endpoints of others found since the last call. They are judged by TakeUnfit all the same.
  std::vector<FoundEndpoint> TakeFound();
  // Null where no impairment was asked for.
  Impairer* ImpairerOrNull() const { return impairer_.get(); }

 private:
  struct DeleteAll {
    void operator()(dds::DomainParticipant* participant) const;
  };

  template <typename Wire>
  dds::Topic& MakeTopic() {
    return MakeTopic(dds::TypeSupport(new typename TopicOf<Wire>::Type), TopicOf<Wire>::kName);
  }
  dds::Topic& MakeTopic(const dds::TypeSupport& type, const std::string& name);
  dds::DataWriter& MakeWriter(dds::Topic& topic, const std::string& profile,
                              const std::string& partition, std::int32_t depth);
  dds::Publisher& MakePublisher(const std::string& partition);
  dds::DataReader& MakeReader(dds::Topic& topic, const std::string& profile,
                              const std::string& partition, std::int32_t depth,
                              dds::DataReaderListener* listener, const dds::StatusMask& mask,
                              const FilterOfTopic& filter);
  dds::TopicDescription& Filtered(dds::Topic& topic, FilterOfTopic filter);
  // That of SetDeadline, if it was called for the profile.
  Duration DeadlineOf(const std::string& profile, const Duration& loaded) const;

  FilterFactory filters_;  // the library asks it until the participant is gone
  std::shared_ptr<Impairer> impairer_;
  std::unique_ptr<DiscoveryListener> naming_;  // of the impairer; before the participant it serves
  DiscoveryListener* listener_ = nullptr;      // the one that the library calls
  std::string topic_prefix_;
  std::string servers_;  // of a client, as they were named; else empty
  bool secured_ = false;
  bool requests_no_times_ = false;
  bool requests_status_once_ = false;
  std::optional<SharedMemoryWatch> memory_;  // none where it uses no shared memory
  std::unique_ptr<dds::DomainParticipant, DeleteAll> participant_;
  std::vector<std::pair<std::string, dds::DataWriter*>> writers_;  // by profile, as they were made
  std::vector<std::pair<std::string, dds::DataReader*>> readers_;
  std::map<std::string, Duration> deadlines_;  // by profile, of those that were changed
  std::map<const dds::DataReader*, std::string> read_topics_;  // of those with a filter
  std::vector<FoundEndpoint> found_;                           // taken, and to be judged
  UnfitEndpoints unfit_;
};

// What an entity is made with: its profile as the library read it, and what code adds. Throw
// LinkError where the loaded set has no such profile.
dds::DomainParticipantQos ParticipantQos(const LinkOptions& options, const std::string& name);
dds::DataWriterQos WriterQos(dds::Publisher& publisher, const std::string& profile,
                             std::int32_t depth);
dds::DataReaderQos ReaderQos(dds::Subscriber& subscriber, const std::string& profile,
                             std::int32_t depth);

// The partition that names a vehicle's own endpoints: "v7".
std::string VehiclePartition(VehicleId vehicle);

}  // namespace giveway::link
