// What a service reads before it is a participant: scenario, profile set, admin key. An operator
// corrects all of them at once, so what is wrong with one must not hide what is with another.
#pragma once

#include <exception>
#include <functional>
#include <stdexcept>
#include <string>

#include "services/config/flags.h"
#include "services/types/admin.h"
#include "services/types/scenario.h"

namespace giveway {

class StartError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// What several inputs are refused for, a line or more each.
class StartErrors {
 public:
  void Add(const std::string& lines) { lines_ += (lines_.empty() ? "" : "\n") + lines; }
  // Runs `read`, and adds what it throws.
  void Collect(const std::function<void()>& read);
  // Throws StartError with all lines, if there are any.
  void Throw() const;

 private:
  std::string lines_;
};

// The profile set; the admin key is read, too, for the time before it waits for servers. Throws
// StartError.
QosProfiles ReadProfilesAndKey(const ServiceFlags& flags, const Scenario& scenario);

// After `error` of the scenario: throws StartError with that, and what is wrong with the profile
// set and the admin key, whatever the fleet.
[[noreturn]] void ThrowWithOtherErrors(const ServiceFlags& flags, const std::string& error);

// What `load` returns, which reads the scenario.
template <typename Load>
auto LoadForStart(const ServiceFlags& flags, const Load& load) {
  try {
    return load();
  } catch (const std::exception& error) {
    ThrowWithOtherErrors(flags, error.what());
  }
}

}  // namespace giveway
