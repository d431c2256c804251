#include "services/auth/seals.h"

#include <cstdint>
#include <string>

#include "services/auth/digest.h"

namespace giveway::auth {
namespace {

// Every number has its width and every text its length: no two values give the same bytes.
class Fields {
 public:
  explicit Fields(std::string_view kind) { Add(kind); }
  void Add(std::uint64_t number) {
    for (unsigned i = 0; i < 8; ++i) bytes_.push_back(static_cast<char>(number >> (8 * i)));
  }
  void Add(std::string_view text) {
    Add(std::uint64_t{text.size()});
    bytes_ += text;
  }
  void Add(const QosProfiles& profiles) {
    Add(std::string_view(profiles.name));
    Add(std::string_view(profiles.text));
  }
  Seal By(std::string_view key) const { return HmacSha256(key, bytes_); }

 private:
  std::string bytes_;
};

}  // namespace

Seal SealOf(std::string_view key, const AdminRequest& order) {
  Fields fields("giveway order 1");
  fields.Add(std::uint64_t{Number(order.vehicle)});
  fields.Add(order.number);
  fields.Add(static_cast<std::uint64_t>(order.kind));
  fields.Add(order.profiles);
  return fields.By(key);
}

Seal SealOf(std::string_view key, const AdminAnswer& answer) {
  Fields fields("giveway answer 1");
  fields.Add(std::uint64_t{Number(answer.vehicle)});
  fields.Add(answer.order);
  fields.Add(static_cast<std::uint64_t>(answer.state));
  fields.Add(std::string_view(answer.reason));
  fields.Add(std::uint64_t{answer.fleet_size});
  fields.Add(std::string_view(answer.interface));
  fields.Add(answer.profiles);
  fields.Add(std::uint64_t{answer.live.size()});
  for (const LiveValue& value : answer.live) {
    fields.Add(std::string_view(value.profile));
    fields.Add(std::string_view(value.policy));
    fields.Add(static_cast<std::uint64_t>(value.number));
  }
  return fields.By(key);
}

bool IsSealed(std::string_view key, const AdminRequest& order) {
  return AreEqual(SealOf(key, order), order.seal);
}

bool IsSealed(std::string_view key, const AdminAnswer& answer) {
  return AreEqual(SealOf(key, answer), answer.seal);
}

}  // namespace giveway::auth
