#include "services/link/impairment/impairer.h"

#include <algorithm>

#include "services/link/fastdds/writer_names.h"

namespace giveway::link {
namespace {

// RTPS header: "RTPS", version (2), vendor (2), GUID prefix (12).
constexpr std::size_t kPrefixAt = 8;
constexpr std::array<std::uint8_t, 4> kMagic = {'R', 'T', 'P', 'S'};
// Later senders share one channel: the prefixes of forged headers must not fill the memory.
constexpr std::size_t kMaxSenders = 4096;

// All zero, which no participant has, for what is no RTPS packet.
PrefixBytes PrefixOf(std::span<const std::uint8_t> packet) {
  PrefixBytes prefix{};
  if (packet.size() < kPrefixAt + prefix.size()) return prefix;
  if (!std::equal(kMagic.begin(), kMagic.end(), packet.begin())) return prefix;
  std::copy_n(packet.begin() + kPrefixAt, prefix.size(), prefix.begin());
  return prefix;
}

Sender NamedBy(const std::vector<std::string>& partitions) {
  if (partitions.size() != 1) return {};
  if (partitions.front() == "world") return {Sender::Kind::kWorld, 0};
  if (partitions.front().find('/') == std::string::npos) return {};
  const VehicleId vehicle = NamedVehicle(partitions);
  if (vehicle == kNoVehicle) return {};
  return {Sender::Kind::kVehicle, Number(vehicle)};
}

}  // namespace

void Impairer::NameOwn(const PrefixBytes& own) {
  const std::scoped_lock lock(mutex_);
  own_ = own;
}

void Impairer::NameHearer(VehicleId hearer) {
  const std::scoped_lock lock(mutex_);
  model_.NameHearer(hearer);
}

void Impairer::Start(SteadyTime now) {
  const std::scoped_lock lock(mutex_);
  model_.Start(now);
}

std::optional<SteadyTime> Impairer::Started() const {
  const std::scoped_lock lock(mutex_);
  return model_.Started();
}

void Impairer::OnWriter(const PrefixBytes& process, const std::vector<std::string>& partitions) {
  const Sender named = NamedBy(partitions);
  if (named.kind == Sender::Kind::kUnknown) return;
  const std::scoped_lock lock(mutex_);
  if (senders_.contains(process) || senders_.size() < kMaxSenders) senders_[process] = named;
}

const Sender& Impairer::SenderOf(const PrefixBytes& process) {
  static const Sender kShared;
  const auto found = senders_.find(process);
  if (found != senders_.end()) return found->second;
  if (senders_.size() >= kMaxSenders) return kShared;
  return senders_[process] = {Sender::Kind::kUnknown, ++unknown_};
}

PacketFate Impairer::Decide(std::span<const std::uint8_t> packet, SteadyTime now) {
  const PrefixBytes prefix = PrefixOf(packet);
  const std::scoped_lock lock(mutex_);
  if (!own_ || prefix == *own_) return {};
  return model_.Decide(SenderOf(prefix), static_cast<std::uint32_t>(packet.size()), now);
}

void Impairer::NoteAbandoned(std::size_t packets) {
  const std::scoped_lock lock(mutex_);
  abandoned_ += packets;
}

ImpairmentCounters Impairer::Counters() const {
  const std::scoped_lock lock(mutex_);
  ImpairmentCounters counters = model_.Counters();
  counters.abandoned = abandoned_;
  return counters;
}

ImpairmentCounters Impairer::CountersOf(VehicleId sender) const {
  const std::scoped_lock lock(mutex_);
  return model_.CountersOf({Sender::Kind::kVehicle, Number(sender)});
}

std::size_t Impairer::Senders() const {
  const std::scoped_lock lock(mutex_);
  return senders_.size();
}

}  // namespace giveway::link
