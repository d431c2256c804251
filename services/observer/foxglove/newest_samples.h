// What one client has subscribed to, and what waits to be sent to it: of each vehicle on a topic
// the newest sample, never a queue, so that a slow client skips samples and its memory is bounded.
// Topics without a key have no newest to stand for the others: of them the last few wait. Knows no
// sockets. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "services/link/raw_link.h"

namespace giveway {

// The same bytes for all clients.
using SharedSample = std::shared_ptr<const link::RawSample>;

// One instance of a keyed topic; of other topics one sample, which `number` counts.
struct SampleKey {
  std::size_t topic = 0;
  std::array<std::uint8_t, 16> instance{};
  std::uint64_t number = 0;
  auto operator<=>(const SampleKey&) const = default;
};

class NewestSamples {
 public:
  static constexpr std::size_t kMostInstances = 4096;  // that wait, of all topics
  static constexpr std::size_t kMostUnkeyed = 256;     // that wait, of all topics without a key

  struct Due {
    std::uint32_t subscription = 0;
    SharedSample sample;
  };

  // Empty, or why it is refused. `topic` is a place in link::RawTopics().
  std::string Subscribe(std::uint32_t subscription, std::size_t topic);
  // Nothing more of it is given out.
  std::string Unsubscribe(std::uint32_t subscription);
  bool IsSubscribed(std::size_t topic) const { return by_topic_.contains(topic); }
  const std::map<std::size_t, std::uint32_t>& ByTopic() const { return by_topic_; }

  // Kept if its topic is subscribed to.
  void Offer(const SharedSample& sample);
  // The one that has waited longest; nothing if none waits.
  std::optional<Due> Take();

  std::size_t Waiting() const { return order_.size(); }
  std::uint64_t Skipped() const { return skipped_; }  // samples that newer ones replaced

 private:
  void DropOldest(bool unkeyed);

  std::map<std::uint32_t, std::size_t> topics_;    // by subscription
  std::map<std::size_t, std::uint32_t> by_topic_;  // subscriptions, the inverse
  std::map<SampleKey, SharedSample> newest_;
  std::deque<SampleKey> order_;  // of newest_, by the time since when something of it waits
  std::size_t unkeyed_waiting_ = 0;
  std::uint64_t unkeyed_ = 0;  // offered so far
  std::uint64_t skipped_ = 0;
};

// The newest of durable topics, for clients that subscribe when a reader has had them already.
class KeptSamples {
 public:
  void Keep(const SharedSample& sample);
  void Clear() { kept_.clear(); }
  // In no order but that of samples without a key.
  template <typename Visit>
  void ForEach(std::size_t topic, Visit&& visit) const {
    for (auto kept = kept_.lower_bound({topic, {}, 0}); kept != kept_.end(); ++kept) {
      if (kept->first.topic != topic) return;
      visit(kept->second);
    }
  }

 private:
  std::map<SampleKey, SharedSample> kept_;
  std::uint64_t unkeyed_ = 0;  // kept so far
};

}  // namespace giveway
