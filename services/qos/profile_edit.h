// Replaces values in the text of a profile file and leaves every other byte of it, comments and
// blanks included, as it was.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/qos/finding.h"
#include "services/qos/policy.h"

namespace giveway::qos {

struct ProfileEdit {
  Owner owner = Owner::kWriter;
  std::string profile;
  Policy policy = Policy::kDeadline;
  std::int64_t value = 0;  // as Profile::Number gives it
};

// The new text, or findings that say why there is none: no XML, or no such profile.
struct EditedProfiles {
  std::string bytes;
  Findings findings;
};

EditedProfiles Edit(std::string bytes, const std::string& file,
                    const std::vector<ProfileEdit>& edits);

// The text with a comment at its top: behind the declaration, if there is one, for nothing but a
// byte order mark or blanks may stand before that.
std::string WithComment(std::string bytes, std::string comment);

}  // namespace giveway::qos
