// The QoS of every endpoint of the fleet as the library resolves it from the loaded profiles, and
// as code changes it afterwards; plain numbers, to be printed or compared. Needs no network.
#pragma once

#include <string>
#include <vector>

#include "services/link/fastdds/link_options.h"
#include "services/link/resolved_value.h"

namespace giveway::link {

struct ResolvedEntity {
  std::string profile;
  std::string topic;  // empty for the participant
  std::vector<ResolvedValue> values;
};

// The participant, then a writer and a reader for each topic. Throws LinkError.
std::vector<ResolvedEntity> ResolveQos(const LinkOptions& options);

}  // namespace giveway::link
