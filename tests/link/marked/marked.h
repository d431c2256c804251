// A writer of an intruder whose packets say that it has asked the reader's filter already.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <vector>

#include "services/link/inbox/participant_of.h"
#include "services/link/participant.h"
#include "tests/link/fleet.h"

namespace giveway::test {

class Unnamed final : public link::DiscoveryListener {
 public:
  void OnWriter(Change, const link::rtps::GUID_t&, const std::vector<std::string>&) override {}
};

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wnon-virtual-dtor"

// Says of every sample that it passes.
class PassesAll final : public link::dds::IContentFilterFactory {
 public:
  link::ReturnCode create_content_filter(const char*, const char*, const link::dds::TopicDataType*,
                                         const char*, const ParameterSeq&,
                                         link::dds::IContentFilter*& filter) override {
    filter = &filter_;
    return link::ReturnCode{};
  }
  link::ReturnCode delete_content_filter(const char*, link::dds::IContentFilter*) override {
    return link::ReturnCode{};
  }
  std::uint32_t Asked() const { return filter_.asked; }

 private:
  struct Filter final : link::dds::IContentFilter {
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
  link::dds::DataWriter* writer_ = nullptr;
};

}  // namespace giveway::test
