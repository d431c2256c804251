// A compose file, as far as it says how the services of a fleet talk: which profile set each is
// given, in which domain and network, and how many there are. Knows YAML, no engine and no DDS.
//
// Services are the fleet's if their image, command or a variable names giveway; others are passed
// over. Of YAML and compose it knows anchors and merge keys, both forms of lists and maps, and
// variables (compose_text.h); an env_file is named as not read.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "services/qos/finding.h"
#include "services/qos/profile_set.h"

namespace giveway::qos {

struct ComposeVariable {
  std::string name;
  std::string value;
  Place place;
};

struct ComposeService {
  std::string name;
  Place place;
  std::vector<ComposeVariable> environment;
  ComposeVariable domain;  // as --domain or GIVEWAY_DOMAIN says last; no name: neither does
  std::string qos;         // as --qos or GIVEWAY_QOS says; empty: the shipped default
  Place qos_place;
  std::vector<std::pair<std::string, std::string>> mounts;  // path on the host, path inside
  std::int64_t containers = 1;
  bool is_vehicle = false;
  bool host_network = false;
  bool host_ipc = false;
};

struct ComposeRead {
  std::vector<ComposeService> services;  // the fleet's, in the order of the file
  Findings findings;                     // of what could not be read
};

// `variables` are NAME=value, for what the file takes from its surroundings.
ComposeRead ReadCompose(std::string_view bytes, const std::string& file,
                        const std::vector<std::string>& variables);

// Of the services together: domains that differ, and misnamed variables.
void CheckCompose(const std::vector<ComposeService>& services, Findings* findings);
// Of one service and the profile set it runs with.
void CheckComposeSet(const ComposeService& service, const ProfileSet& set, Findings* findings);

// The path on the host of what `inside` names in the service's container; empty if no volume
// mounts it.
std::string HostPath(const ComposeService& service, const std::string& inside);

}  // namespace giveway::qos
