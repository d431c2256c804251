#include "services/observer/foxglove/foxglove_feed.h"

#include <exception>
#include <utility>
#include <vector>

#include "services/observer/capture/fleet_capture.h"
#include "services/runtime/process.h"

namespace giveway {
namespace {

// A client that connects again, or a panel that is changed, does not make the fleet find us again.
constexpr Nanoseconds kStaysOpen = std::chrono::seconds(10);
constexpr Nanoseconds kRetry = std::chrono::seconds(5);

bool Has(std::uint64_t set, std::size_t topic) { return ((set >> topic) & 1U) != 0; }

}  // namespace

std::vector<FoxgloveChannel> FoxgloveChannels() {
  std::vector<FoxgloveChannel> channels;
  const std::string idl = FleetIdl();
  for (std::size_t topic = 0; topic < link::RawTopics().size(); ++topic) {
    ChannelDescription described = DescribeChannel(topic);
    channels.push_back({.id = static_cast<std::uint32_t>(topic + 1),
                        .topic = std::move(described.topic),
                        .encoding = std::move(described.encoding),
                        .schema_name = std::move(described.schema_name),
                        .schema_encoding = std::move(described.schema_encoding),
                        .schema = idl});
  }
  return channels;
}

FoxgloveFeed::FoxgloveFeed(link::LinkOptions fleet, FoxgloveOptions server)
    : fleet_(std::move(fleet)), server_(std::move(server)) {}

void FoxgloveFeed::Open(std::uint64_t wanted, SteadyTime now) {
  if (now < not_before_) return;
  try {
    if (link_ == nullptr) {
      link_ = std::make_unique<link::RawLink>(fleet_, std::vector<std::size_t>{});
      LogInfo("reads the fleet's samples for Foxglove");
    }
    for (std::size_t topic = 0; topic < link::RawTopics().size(); ++topic) {
      if (!Has(wanted & ~open_, topic)) continue;
      link_->Open(topic);
      open_ |= std::uint64_t{1} << topic;
    }
  } catch (const std::exception& error) {
    RetryAfter(error, now);
  }
}

void FoxgloveFeed::RetryAfter(const std::exception& error, SteadyTime now) {
  LogWarning("cannot read for Foxglove, repeats it in 5 s: " + std::string(error.what()));
  not_before_ = now + kRetry;
}

void FoxgloveFeed::Turn(SteadyTime now) {
  const std::uint64_t wanted = server_.Wanted();
  if (wanted != 0) {
    wanted_at_ = now;
    if ((wanted & ~open_) != 0) Open(wanted, now);
  } else if (link_ != nullptr && now - wanted_at_ > kStaysOpen) {
    link_.reset();
    open_ = 0;
    server_.ForgetKept();
    LogInfo("no longer reads the fleet's samples for Foxglove");
  }
  if (link_ == nullptr) return;
  std::vector<link::RawSample> samples;
  std::uint64_t kept = 0;
  try {
    link_->Take([&](link::RawSample sample) {
      const bool durable = link_->IsDurable(sample.topic);
      if (durable) kept |= std::uint64_t{1} << sample.topic;
      if (durable || Has(wanted, sample.topic)) samples.push_back(std::move(sample));
    });
  } catch (const link::LinkError& error) {  // it could not replace its participant
    link_.reset();
    open_ = 0;
    server_.ForgetKept();  // the next one is given it again
    RetryAfter(error, now);
  }
  if (!samples.empty()) server_.Publish(std::move(samples), kept);
}

}  // namespace giveway
