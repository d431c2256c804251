// Writers that are deleted while readers have not acknowledged what they wrote, as where a peer was
// killed.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <future>
#include <memory>
#include <thread>
#include <utility>

#include "services/link/fastdds/writer_names.h"
#include "services/link/participant.h"
#include "tests/link/fleet.h"

namespace giveway::test {
namespace {

namespace dds = link::dds;
using wire::Event;

constexpr char kTopic[] = "test/deleted_writer";

template <typename Times>
void SetResponseDelay(Times& times, const link::Duration& delay) {
  if constexpr (requires { times.heartbeatResponseDelay; }) {
    times.heartbeatResponseDelay = delay;
  } else {
    times.heartbeat_response_delay = delay;
  }
}

// A reader that matches and acknowledges nothing while the test lasts.
class SilentReader {
 public:
  explicit SilentReader(const link::LinkOptions& options)
      : participant_(dds::DomainParticipantFactory::get_instance()->create_participant(
            options.domain, link::ParticipantQos(options, "silent"))) {
    const dds::TypeSupport type(new link::TopicOf<Event>::Type);
    type.register_type(participant_);
    dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
    qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    SetResponseDelay(qos.reliable_reader_qos().times, link::Duration(1000, 0));
    participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT)
        ->create_datareader(
            participant_->create_topic(kTopic, type.get_type_name(), dds::TOPIC_QOS_DEFAULT), qos);
  }
  ~SilentReader() {
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  SilentReader(const SilentReader&) = delete;
  SilentReader& operator=(const SilentReader&) = delete;

 private:
  dds::DomainParticipant* participant_;
};

// Many samples, and a heartbeat each millisecond: several fall into the deletion.
dds::DataWriterQos OfManySamples(std::int32_t samples) {
  dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
  qos.history().depth = samples;
  qos.resource_limits().max_samples = samples;
  qos.resource_limits().max_samples_per_instance = samples;
  link::SetHeartbeatPeriod(qos, link::Duration(0, 1'000'000));
  return qos;
}

// Ends the process where it takes too long: a thread that hangs cannot be ended.
void WithinAMinute(const char* what, const std::function<void()>& does) {
  std::packaged_task<void()> task(does);
  const std::future<void> done = task.get_future();
  std::thread thread(std::move(task));
  if (done.wait_for(std::chrono::minutes(1)) != std::future_status::ready) {
    std::printf("[  FAILED  ] %s hangs\n", what);
    std::fflush(stdout);
    std::_Exit(1);
  }
  thread.join();
}

// The library's heartbeats looked through a history whose samples were being released, and never
// came to its end.
TEST(DeletedWriter, HeartbeatsDoNotMeetItsReleasedSamples) {
  constexpr std::int32_t kSamples = 4000;
  const DomainLock domain;
  link::WriterNames names;
  auto participant = std::make_unique<link::Participant>(OptionsIn(domain), "deletes", names);
  const SilentReader reader(OptionsIn(domain));  // its profiles are loaded by then
  const auto write_many = [&](dds::DataWriter& entity) {
    link::Writer<Event> writer(entity);
    ASSERT_TRUE(Eventually([&] { return writer.HasReader(); }));
    for (std::int32_t i = 0; i < kSamples; ++i) ASSERT_TRUE(writer.Write(Event()));
    EXPECT_FALSE(writer.WaitUntilHeard(Nanoseconds(1)));
  };
  const auto make = [&]() -> dds::DataWriter& {
    return participant->MakeForeignWriter(dds::TypeSupport(new link::TopicOf<Event>::Type), kTopic,
                                          OfManySamples(kSamples));
  };
  dds::DataWriter& alone = make();
  write_many(alone);
  WithinAMinute("the deletion of a writer", [&] { participant->Delete(alone); });
  write_many(make());
  WithinAMinute("the deletion of a participant", [&] { participant.reset(); });
}

}  // namespace
}  // namespace giveway::test
