#include "services/link/operator_link.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <set>
#include <utility>

#include "services/auth/seals.h"
#include "services/link/convert/convert.h"
#include "services/link/inbox/participant_of.h"
#include "services/link/participant.h"
#include "services/link/participant_names.h"
#include "services/types/check.h"

namespace giveway::link {
namespace {

constexpr std::size_t kMostRefusedAnswers = 4;  // kept for the log; the counter has all
constexpr std::size_t kMostHeld = 16;           // answers; the oldest are dropped

// An answer of a participant that may not speak for the vehicle, or not yet: of a process that
// restarted it comes before the former participant is known to be gone.
struct HeldAnswer {
  AdminAnswer answer;
  rtps::GUID_t writer;
};

}  // namespace

struct OperatorLink::Impl {
  Impl(const LinkOptions& given, std::string admin_key)
      : options(given),
        key(std::move(admin_key)),
        participant(options, "giveway-operator", names),
        answers(participant.MakeReader<wire::Answer>("v*", &strangers)) {}

  // A refusal changes nothing, and may come from a service that cannot seal it.
  bool IsBelieved(AdminAnswer* answer) const {
    if (key.empty() || auth::IsSealed(key, *answer)) return true;
    answer->seal = {};
    return answer->state == AnswerState::kRefused;
  }
  void Refuse(const AdminAnswer& answer, const rtps::GUID_t& writer, const char* field,
              const char* why) {
    ++refused;
    if (refusals.size() == kMostRefusedAnswers) return;
    refusals.push_back({.sample = "answer",
                        .vehicle = answer.vehicle,
                        .writer = Identity(writer),
                        .counter = "strangers",
                        .field = field,
                        .why = why});
  }
  // As with a status: an answer in the name of another vehicle than its partition's, or than the
  // participant drives as, is refused.
  bool MaySpeak(const AdminAnswer& answer, const rtps::GUID_t& writer) {
    const WriterEntry* const entry = names.Writers().Find(writer);
    return entry != nullptr && entry->vehicle == answer.vehicle &&
           names.Owns(entry->vehicle, writer);
  }
  void Hold(const AdminAnswer& answer, const rtps::GUID_t& writer) {
    if (held.size() == kMostHeld) held.erase(held.begin());
    held.push_back({answer, writer});
  }
  // Whether it counts; if not, it is refused.
  bool Accepts(AdminAnswer* answer, const rtps::GUID_t& writer) {
    if (IsBelieved(answer)) return true;
    Refuse(*answer, writer, "seal", "it is not sealed with the key of this fleet");
    return false;
  }
  Writer<wire::Order>& To(VehicleId vehicle) {
    const auto found = writers.find(vehicle);
    GIVEWAY_CHECK(found != writers.end(), Number(vehicle));
    return found->second;
  }

  const LinkOptions options;
  const std::string key;
  ParticipantNames names;  // the library calls it until the participant is gone
  KeyQuota strangers{"answer", KeyQuota::Key::kVehicle, KeyQuota::Of::kWriter, kMostIdsOfWriter};
  Participant participant;
  Reader<wire::Answer> answers;
  std::map<VehicleId, Writer<wire::Order>> writers;
  std::vector<HeldAnswer> held;
  std::vector<Refusal> refusals;
  std::uint32_t refused = 0;  // by this side; the filter has its own
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

bool OperatorLink::Send(const AdminRequest& order) {
  AdminRequest sealed = order;
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

// As ObserverLink.
void OperatorLink::RenewIfDeaf() {
  if (!impl_->participant.SharedMemoryIsGone()) return;
  const LinkOptions options = WithoutSharedMemory(impl_->options);
  const std::string key = impl_->key;
  std::vector<VehicleId> sought;
  for (const auto& writer : impl_->writers) sought.push_back(writer.first);
  impl_.reset();
  impl_ = std::make_unique<Impl>(options, key);
  for (const VehicleId vehicle : sought) Seek(vehicle);
}

std::vector<AdminAnswer> OperatorLink::Take() {
  RenewIfDeaf();
  impl_->names.Writers().Update();
  std::vector<AdminAnswer> taken;
  for (HeldAnswer& held : std::exchange(impl_->held, {})) {
    if (!impl_->MaySpeak(held.answer, held.writer)) {
      impl_->Hold(held.answer, held.writer);
    } else if (impl_->Accepts(&held.answer, held.writer)) {
      taken.push_back(std::move(held.answer));
    }
  }
  impl_->answers.TakeEach([&](const wire::Answer& sample, const dds::SampleInfo& info) {
    const rtps::GUID_t& writer = info.sample_identity.writer_guid();
    AdminAnswer answer;
    if (!FromWire(sample, answer)) return;
    if (!impl_->MaySpeak(answer, writer)) {
      impl_->Refuse(answer, writer, "writer", "another participant speaks for this id");
      impl_->Hold(answer, writer);
    } else if (impl_->Accepts(&answer, writer)) {
      taken.push_back(std::move(answer));
    }
  });
  return taken;
}

std::uint32_t OperatorLink::Refused() const { return impl_->refused + impl_->strangers.Refused(); }

std::vector<Refusal> OperatorLink::TakeRefusals() {
  std::vector<Refusal> refusals = std::exchange(impl_->refusals, {});
  impl_->strangers.TakeRefusals(&refusals);
  return refusals;
}

}  // namespace giveway::link
