// A recorder's side: every sample of every topic as its writer serialized it, with both times.
// Decodes nothing, writes nothing.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "services/link/fastdds/link_options.h"

namespace giveway::link {

class GivenSamples;

struct RawSample {
  std::size_t topic = 0;                    // its place in RawTopics()
  std::uint64_t source_ns = 0;              // by the writer's clock, since 1970
  std::uint64_t reception_ns = 0;           // by ours, since 1970
  std::uint32_t sequence = 0;               // of its writer, the lower half
  std::string bytes;                        // encapsulation header and CDR
  std::array<std::uint8_t, 16> instance{};  // its key, or a hash of it; zeros where there is none
};

struct RawTopic {
  std::string_view name;  // "fleet/beacon"
  std::string_view type;  // "giveway::wire::Beacon"
  bool keyed = false;     // has instances: a vehicle's samples replace those of the same vehicle
};

// All that can be recorded: what vehicles and world say. Profiles sent by an operator stay out.
const std::vector<RawTopic>& RawTopics();

class RawLink {
 public:
  // Reads the topics at these places of RawTopics(), and no other. Throws LinkError.
  RawLink(const LinkOptions& options, const std::vector<std::size_t>& topics);
  ~RawLink();
  RawLink(const RawLink&) = delete;
  RawLink& operator=(const RawLink&) = delete;

  // Reads this topic, too, from here on; nothing where it is read already. Throws LinkError. None
  // is closed before all are: the library removes readers of a running participant unsafely.
  void Open(std::size_t topic);
  // Calls take(sample) for all that came since the last call; of one instance in order. Where its
  // shared memory was deleted it replaces its participant, as ObserverLink::Take; what writers keep
  // for the new one and was given before, is not given again.
  template <typename TakeSample>
  void Take(TakeSample&& take) {
    Collect();
    for (RawSample& sample : samples_) take(std::move(sample));
    samples_.clear();
  }
  // What the reader of this topic asks for, for people: "BEST_EFFORT, VOLATILE, deadline 150 ms".
  std::string QosText(std::size_t topic) const;
  // Whether this topic is read, and its writers keep the newest samples for readers that come late.
  bool IsDurable(std::size_t topic) const;

 private:
  struct Impl;
  struct OpenTopic;
  void Collect();
  void RenewIfDeaf();
  const OpenTopic* Find(std::size_t topic) const;

  std::unique_ptr<GivenSamples> given_;  // outlives a participant
  std::unique_ptr<Impl> impl_;
  std::vector<RawSample> samples_;
};

}  // namespace giveway::link
