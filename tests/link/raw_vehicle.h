// A vehicle made of the link's inner parts, for what VehicleLink rightly never does: beacons with
// the wrong name or a broken sum, and a look at what the library itself reports.
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "services/link/convert/convert.h"
#include "services/link/fastdds/reader_events.h"
#include "services/link/inbox/beacon_inbox.h"
#include "services/link/inbox/peer_events.h"
#include "services/link/participant.h"

namespace giveway::test {

class RawSender {
 public:
  RawSender(const link::LinkOptions& options, const std::string& partition)
      : participant_(options, "raw-sender", names_),
        writer_(participant_.MakeWriter<wire::Beacon>(partition)) {}
  bool Send(const wire::Beacon& sample) { return writer_.Write(sample); }

 private:
  link::WriterNames names_;
  link::Participant participant_;
  link::Writer<wire::Beacon> writer_;
};

class RawListener {
 public:
  explicit RawListener(const link::LinkOptions& options)
      : participant_(options, "raw-listener", names_),
        reader_(participant_.MakeReader<wire::Beacon>(options.area + "/*",
                                                      link::Participant::kProfileDepth, &events_,
                                                      link::ReaderEvents::Mask())),
        inbox_(reader_, names_, participant_.Prefix()),
        peers_(names_, participant_.Prefix(), "main") {}

  // The first half of a turn: nothing is drained.
  void FollowMatches() {
    const link::ReaderNews news = events_.Take();
    for (const link::ReaderEvent& event : news.events) {
      if (event.kind != link::ReaderEvent::Kind::kDeadlineMissed) continue;
      ++raw_misses_;
      ++raw_misses_of_[VehicleId{link::KeyOf(event.handle)}];
    }
    names_.Update();
    peers_.Translate(news, SteadyTime{0}, qos_events_);
  }
  // One turn of VehicleLink::Take, but that no clock watches.
  void Listen() {
    FollowMatches();
    beacons_.clear();
    inbox_.Drain(SteadyTime{0}, beacons_);
    for (const ReceivedBeacon& received : beacons_) {
      peers_.Heard(received.beacon.vehicle, SteadyTime{0});
      vehicles_.insert(received.beacon.vehicle);
    }
    heard_ += beacons_.size();
  }
  std::size_t Heard() const { return heard_; }
  const std::set<VehicleId>& Vehicles() const { return vehicles_; }  // heard at least once
  // As often as the library said so, at most once a turn and vehicle.
  std::size_t RawMisses() const { return raw_misses_; }
  std::size_t RawMissesOf(VehicleId vehicle) const {
    const auto found = raw_misses_of_.find(vehicle);
    return found == raw_misses_of_.end() ? 0 : found->second;
  }
  std::size_t EventCount() const { return qos_events_.size(); }
  std::size_t EventCount(QosEventKind kind) const {
    return static_cast<std::size_t>(
        std::count_if(qos_events_.begin(), qos_events_.end(),
                      [kind](const QosEvent& event) { return event.kind == kind; }));
  }
  std::uint32_t Matched() const { return peers_.MatchedWriters(); }
  // Instances that the reader still has of those that are gone.
  std::size_t Departed() {
    std::set<link::dds::InstanceHandle_t> departed;
    const link::Loan<wire::Beacon> loan(reader_.Entity(), [this](auto& samples, auto& infos) {
      return reader_.Entity().read(samples, infos, link::dds::LENGTH_UNLIMITED,
                                   link::dds::ANY_SAMPLE_STATE, link::dds::ANY_VIEW_STATE,
                                   link::dds::NOT_ALIVE_INSTANCE_STATE);
    });
    for (int i = 0; i < loan.Size(); ++i) departed.insert(loan.Info(i).instance_handle);
    return departed.size();
  }
  std::uint32_t Superseded() { return inbox_.Superseded(); }
  std::uint32_t Unbound() const { return inbox_.Unbound(); }
  std::uint32_t Unreadable() const { return inbox_.Unreadable(); }

 private:
  link::WriterNames names_;
  link::ReaderEvents events_{&link::RemoveDeparted<wire::Beacon>};
  link::Participant participant_;
  link::Reader<wire::Beacon> reader_;
  link::BeaconInbox inbox_;
  link::PeerEvents peers_;
  std::vector<ReceivedBeacon> beacons_;
  std::vector<QosEvent> qos_events_;
  std::size_t heard_ = 0;
  std::set<VehicleId> vehicles_;
  std::size_t raw_misses_ = 0;
  std::map<VehicleId, std::size_t> raw_misses_of_;
};

}  // namespace giveway::test
