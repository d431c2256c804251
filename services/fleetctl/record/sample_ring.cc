#include "services/fleetctl/record/sample_ring.h"

#include <algorithm>
#include <utility>

namespace giveway::fleetctl {

SampleRing::SampleRing(double last_s) : last_ns_(static_cast<std::uint64_t>(last_s * 1e9)) {}

void SampleRing::DropFirst() {
  bytes_ -= samples_.front().bytes.size() + sizeof(link::RawSample);
  samples_.pop_front();
}

void SampleRing::Add(link::RawSample sample) {
  newest_ns_ = std::max(newest_ns_, sample.reception_ns);
  bytes_ += sample.bytes.size() + sizeof(link::RawSample);
  samples_.push_back(std::move(sample));
  while (newest_ns_ - samples_.front().reception_ns > last_ns_) DropFirst();
  while (bytes_ > kMostBytes) {
    DropFirst();
    ++dropped_;
  }
}

}  // namespace giveway::fleetctl
