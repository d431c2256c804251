#include "services/observer/foxglove/newest_samples.h"

#include <algorithm>

namespace giveway {
namespace {

SampleKey KeyOf(const link::RawSample& sample, std::uint64_t* unkeyed) {
  if (link::RawTopics().at(sample.topic).keyed) return {sample.topic, sample.instance, 0};
  return {sample.topic, {}, ++*unkeyed};
}

}  // namespace

std::string NewestSamples::Subscribe(std::uint32_t subscription, std::size_t topic) {
  if (topics_.contains(subscription)) {
    return "subscription " + std::to_string(subscription) + " is in use";
  }
  if (by_topic_.contains(topic)) {
    return std::string(link::RawTopics().at(topic).name) + " is subscribed to already";
  }
  topics_[subscription] = topic;
  by_topic_[topic] = subscription;
  return {};
}

std::string NewestSamples::Unsubscribe(std::uint32_t subscription) {
  const auto found = topics_.find(subscription);
  if (found == topics_.end()) {
    return "there is no subscription " + std::to_string(subscription);
  }
  const std::size_t topic = found->second;
  const auto is_of_topic = [topic](const SampleKey& key) { return key.topic == topic; };
  unkeyed_waiting_ -= static_cast<std::size_t>(std::ranges::count_if(
      order_, [&](const SampleKey& key) { return is_of_topic(key) && key.number != 0; }));
  std::erase_if(order_, is_of_topic);
  std::erase_if(newest_, [&](const auto& waiting) { return is_of_topic(waiting.first); });
  by_topic_.erase(topic);
  topics_.erase(found);
  return {};
}

void NewestSamples::DropOldest(bool unkeyed) {
  const auto oldest = std::ranges::find_if(
      order_, [unkeyed](const SampleKey& key) { return !unkeyed || key.number != 0; });
  if (oldest->number != 0) --unkeyed_waiting_;
  newest_.erase(*oldest);
  order_.erase(oldest);
  ++skipped_;
}

void NewestSamples::Offer(const SharedSample& sample) {
  if (!IsSubscribed(sample->topic)) return;
  const SampleKey key = KeyOf(*sample, &unkeyed_);
  SharedSample& slot = newest_[key];
  if (slot != nullptr) {
    ++skipped_;
  } else {
    order_.push_back(key);
    if (key.number != 0) ++unkeyed_waiting_;
  }
  slot = sample;
  if (unkeyed_waiting_ > kMostUnkeyed) DropOldest(true);
  if (order_.size() > kMostInstances) DropOldest(false);
}

std::optional<NewestSamples::Due> NewestSamples::Take() {
  if (order_.empty()) return std::nullopt;
  const auto waiting = newest_.find(order_.front());
  Due due{by_topic_.at(waiting->first.topic), std::move(waiting->second)};
  if (waiting->first.number != 0) --unkeyed_waiting_;
  newest_.erase(waiting);
  order_.pop_front();
  return due;
}

void KeptSamples::Keep(const SharedSample& sample) {
  const SampleKey key = KeyOf(*sample, &unkeyed_);
  if (key.number != 0) {
    const auto first = kept_.lower_bound({key.topic, {}, 0});
    const auto end = kept_.lower_bound({key.topic + 1, {}, 0});
    if (std::distance(first, end) >= static_cast<std::ptrdiff_t>(NewestSamples::kMostUnkeyed)) {
      kept_.erase(first);
    }
  } else if (kept_.size() >= NewestSamples::kMostInstances && !kept_.contains(key)) {
    return;
  }
  kept_[key] = sample;
}

}  // namespace giveway
