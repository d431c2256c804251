#include "tests/attack/speak/intruder.h"

#include <stdexcept>
#include <thread>

#include "services/link/fastdds/profile_file.h"

namespace giveway::attack {

using std::chrono::steady_clock;

link::LinkOptions OptionsOf(const Orders& orders) {
  link::LinkOptions options;
  options.domain = orders.domain;
  options.qos = link::ReadProfileFile(orders.qos_file);
  return options;
}

Intruder::Intruder(const Orders& orders)
    : orders_(orders),
      participant_(OptionsOf(orders), "intruder", listener_),
      roster_(participant_.MakeReader<wire::Roster>(link::kWorldPartition)),
      truth_(participant_.MakeReader<wire::Truth>(link::kWorldPartition)) {}

void Intruder::Take() {
  roster_.TakeEach([&](const wire::Roster& sample, const link::dds::SampleInfo&) {
    RosterEntry entry;
    if (link::FromWire(sample, entry)) entries_[entry.vehicle] = entry;
  });
  truth_.TakeEach([&](const wire::Truth& sample, const link::dds::SampleInfo&) {
    Truth truth;
    if (link::FromWire(sample, truth)) truths_[truth.vehicle] = truth;
  });
}

void Intruder::Await(const std::function<bool()>& done, const char* why_not) {
  const auto give_up = steady_clock::now() + std::chrono::seconds(10);
  while (!done()) {
    if (steady_clock::now() > give_up) throw std::runtime_error(why_not);
    std::this_thread::sleep_for(milliseconds(10));
  }
}

void Intruder::LookRound() {
  Await(
      [this] {
        Take();
        return entries_.contains(orders_.target) && truths_.contains(orders_.target);
      },
      "no world publishes the target");
}

const Truth& Intruder::TargetNow() {
  Take();
  return truths_.at(orders_.target);
}

void Intruder::Repeat(milliseconds period, const std::function<void(std::uint32_t)>& say) const {
  const auto begun = steady_clock::now();
  auto next = begun;
  for (std::uint32_t i = 0; next < begun + orders_.duration; ++i, next += period) {
    std::this_thread::sleep_until(next);
    say(i);
  }
  std::this_thread::sleep_for(milliseconds(200));
}

}  // namespace giveway::attack
