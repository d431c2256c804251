#include "services/link/operator_link.h"

#include <map>
#include <set>

#include "services/link/convert/convert.h"
#include "services/link/fastdds/writer_names.h"
#include "services/link/participant.h"
#include "services/types/check.h"

namespace giveway::link {

struct OperatorLink::Impl {
  explicit Impl(const LinkOptions& options)
      : participant(options, "giveway-operator", names),
        answers(participant.MakeReader<wire::Answer>("v*")) {}

  Writer<wire::Order>& To(VehicleId vehicle) {
    const auto found = writers.find(vehicle);
    GIVEWAY_CHECK(found != writers.end(), Number(vehicle));
    return found->second;
  }

  WriterNames names;  // the library calls it until the participant is gone
  Participant participant;
  Reader<wire::Answer> answers;
  std::map<VehicleId, Writer<wire::Order>> writers;
};

OperatorLink::OperatorLink(const LinkOptions& options) : impl_(std::make_unique<Impl>(options)) {}
OperatorLink::~OperatorLink() = default;

void OperatorLink::Seek(VehicleId vehicle) {
  GIVEWAY_CHECK(!impl_->writers.contains(vehicle), Number(vehicle));
  impl_->writers.emplace(vehicle,
                         impl_->participant.MakeWriter<wire::Order>(VehiclePartition(vehicle)));
}

std::vector<VehicleId> OperatorLink::Announced() {
  impl_->names.Update();
  std::set<VehicleId> vehicles;
  impl_->names.ForEach([&](const WriterEntry& entry) {
    if (!entry.area.empty()) vehicles.insert(entry.vehicle);
  });
  return {vehicles.begin(), vehicles.end()};
}

bool OperatorLink::Reaches(VehicleId vehicle) const { return impl_->To(vehicle).HasReader(); }

bool OperatorLink::Send(const AdminOrder& order) {
  return impl_->To(order.vehicle).Write(ToWire(order));
}

std::vector<AdminAnswer> OperatorLink::Take() {
  impl_->names.Update();
  std::vector<AdminAnswer> taken;
  impl_->answers.TakeEach([&](const wire::Answer& sample, const dds::SampleInfo& info) {
    // As with a status: who speaks for another vehicle than its partition's is not believed.
    const WriterEntry* const writer = impl_->names.Find(info.sample_identity.writer_guid());
    AdminAnswer answer;
    if (writer != nullptr && writer->vehicle == VehicleId{sample.vehicle()} &&
        FromWire(sample, answer)) {
      taken.push_back(std::move(answer));
    }
  });
  return taken;
}

}  // namespace giveway::link
