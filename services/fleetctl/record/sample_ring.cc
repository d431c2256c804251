#include "services/fleetctl/record/sample_ring.h"

#include <utility>

namespace giveway::fleetctl {

SampleRing::SampleRing(double last_s) : last_(FromSeconds(last_s)) {}

void SampleRing::DropFirst() {
  bytes_ -= samples_.front().bytes.size() + sizeof(link::RawSample);
  samples_.pop_front();
  added_at_.pop_front();
}

void SampleRing::Add(link::RawSample sample, SteadyTime now) {
  bytes_ += sample.bytes.size() + sizeof(link::RawSample);
  samples_.push_back(std::move(sample));
  added_at_.push_back(now);
  while (!samples_.empty() && now - added_at_.front() > last_) DropFirst();
  while (!samples_.empty() && bytes_ > kMostBytes) {
    DropFirst();
    ++dropped_;
  }
}

}  // namespace giveway::fleetctl
