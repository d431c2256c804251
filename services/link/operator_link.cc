#include "services/link/operator_link.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <set>
#include <utility>

#include "services/auth/seals.h"
#include "services/link/convert/convert.h"
#include "services/link/participant.h"
#include "services/link/participant_names.h"
#include "services/types/check.h"

namespace giveway::link {

struct OperatorLink::Impl {
  Impl(const LinkOptions& options, std::string admin_key)
      : key(std::move(admin_key)),
        participant(options, "giveway-operator", names),
        answers(participant.MakeReader<wire::Answer>("v*", &strangers)) {}

  // A refusal changes nothing, and may come from a service that cannot seal it.
  bool IsBelieved(AdminAnswer* answer) const {
    if (key.empty() || auth::IsSealed(key, *answer)) return true;
    answer->seal = {};
    return answer->state == AnswerState::kRefused;
  }
  Writer<wire::Order>& To(VehicleId vehicle) {
    const auto found = writers.find(vehicle);
    GIVEWAY_CHECK(found != writers.end(), Number(vehicle));
    return found->second;
  }

  const std::string key;
  ParticipantNames names;  // the library calls it until the participant is gone
  KeyQuota strangers{"answer", KeyQuota::Key::kVehicle, KeyQuota::Of::kWriter, kMostIdsOfWriter};
  Participant participant;
  Reader<wire::Answer> answers;
  std::map<VehicleId, Writer<wire::Order>> writers;
};

OperatorLink::OperatorLink(const LinkOptions& options, std::string key)
    : impl_(std::make_unique<Impl>(options, std::move(key))) {}
OperatorLink::~OperatorLink() = default;

void OperatorLink::Seek(VehicleId vehicle) {
  GIVEWAY_CHECK(!impl_->writers.contains(vehicle), Number(vehicle));
  impl_->writers.emplace(vehicle,
                         impl_->participant.MakeWriter<wire::Order>(VehiclePartition(vehicle)));
}

std::vector<VehicleId> OperatorLink::Announced() {
  impl_->names.Writers().Update();
  std::set<VehicleId> vehicles;
  impl_->names.Writers().ForEach([&](const WriterEntry& entry) {
    if (!entry.area.empty()) vehicles.insert(entry.vehicle);
  });
  return {vehicles.begin(), vehicles.end()};
}

bool OperatorLink::Reaches(VehicleId vehicle) const { return impl_->To(vehicle).HasReader(); }

bool OperatorLink::Send(const AdminOrder& order) {
  AdminOrder sealed = order;
  if (!impl_->key.empty()) sealed.seal = auth::SealOf(impl_->key, order);
  return impl_->To(order.vehicle).Write(ToWire(sealed));
}

std::uint64_t OperatorLink::NextNumber() {
  static std::atomic<std::uint64_t> last{0};
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto now_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
  std::uint64_t before = last;
  std::uint64_t next = 0;
  do {
    next = std::max(before + 1, static_cast<std::uint64_t>(now_ns));
  } while (!last.compare_exchange_weak(before, next));
  return next;
}

std::vector<AdminAnswer> OperatorLink::Take() {
  impl_->names.Writers().Update();
  std::vector<AdminAnswer> taken;
  impl_->answers.TakeEach([&](const wire::Answer& sample, const dds::SampleInfo& info) {
    // As with a status: who speaks for another vehicle than its partition's, or than it drives as,
    // is not believed.
    const rtps::GUID_t& guid = info.sample_identity.writer_guid();
    const WriterEntry* const writer = impl_->names.Writers().Find(guid);
    AdminAnswer answer;
    if (writer != nullptr && writer->vehicle == VehicleId{sample.vehicle()} &&
        impl_->names.Owns(writer->vehicle, guid) && FromWire(sample, answer) &&
        impl_->IsBelieved(&answer)) {
      taken.push_back(std::move(answer));
    }
  });
  return taken;
}

}  // namespace giveway::link
