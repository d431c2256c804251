#include "services/node/start_inputs.h"

#include "services/node/admin_access.h"
#include "services/node/qos_at_start.h"

namespace giveway {
namespace {

QosProfiles CollectProfilesAndKey(const ServiceFlags& flags, const Scenario& scenario,
                                  StartErrors* errors) {
  QosProfiles profiles;
  errors->Collect([&] { profiles = ReadSoundQos(flags.qos, scenario); });
  errors->Collect([&] { AdminGateOf(flags); });
  return profiles;
}

}  // namespace

void StartErrors::Collect(const std::function<void()>& read) {
  try {
    read();
  } catch (const std::exception& error) {
    Add(error.what());
  }
}

void StartErrors::Throw() const {
  if (!lines_.empty()) throw StartError(lines_);
}

QosProfiles ReadProfilesAndKey(const ServiceFlags& flags, const Scenario& scenario) {
  StartErrors errors;
  QosProfiles profiles = CollectProfilesAndKey(flags, scenario, &errors);
  errors.Throw();
  return profiles;
}

void ThrowWithOtherErrors(const ServiceFlags& flags, const std::string& error) {
  StartErrors errors;
  errors.Add(error);
  Scenario unknown;
  unknown.tick_period = Nanoseconds{0};  // then no rule speaks of it
  // A trial of a set is asked for nothing else.
  if (flags.try_qos.empty()) CollectProfilesAndKey(flags, unknown, &errors);
  errors.Throw();
  throw StartError("could not start");
}

}  // namespace giveway
