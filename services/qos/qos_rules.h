// The rules of `fleetctl qos check`, by what they look at. Each adds its findings; none depends on
// another having run.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "services/qos/deployment.h"
#include "services/qos/finding.h"
#include "services/qos/profile_set.h"

namespace giveway::qos {

// Of a file as a whole: profiles twice, missing, or unused.
void CheckNames(const ProfileSet& set, const Deployment& deployment, Findings* findings);
// Of every pair: writers of one file, readers of another or the same.
void CheckPairs(const ProfileSet& writers, const ProfileSet& readers, Findings* findings);
// Of two sets: whether processes with one discover those with the other.
void CheckFindEachOther(const ProfileSet& a, const ProfileSet& b, Findings* findings);
// Of a writer or a reader, whatever its topic.
void CheckEndpoint(const Profile& profile, Findings* findings);
// Of a writer or a reader of a topic of the fleet, against the fleet's size and rates.
void CheckFleet(const Profile& profile, const Topic& topic, const Deployment& deployment,
                Findings* findings);
void CheckParticipants(const ProfileSet& set, const Deployment& deployment, Findings* findings);
void CheckTransports(const ProfileSet& set, const Deployment& deployment, Findings* findings);
// Of what surrounds the processes: variables and files that the library reads by itself.
void CheckSurroundings(const Deployment& deployment, Findings* findings);

// The names of the variables that the programs of this project read.
std::span<const std::string_view> OwnVariables();
// Of one variable by its name; `is_set` says where: "is set in the environment".
void CheckVariable(std::string_view name, const Place& place, const std::string& is_set,
                   Findings* findings);

// Where a value is said, else the profile that leaves it to the library.
inline const Place& PlaceOf(const Profile& profile, Policy policy) {
  return profile[policy].given ? profile[policy].place : profile.place;
}
// "max_instances 10 (library default)".
std::string StatedValue(const Profile& profile, Policy policy);

}  // namespace giveway::qos
