#include "services/fleetctl/qos/qos_in_child.h"

#include <sstream>
#include <string>

#include "services/fleetctl/process/run_in_child.h"

namespace giveway::fleetctl {
namespace {

constexpr Nanoseconds kResolvePatience = std::chrono::seconds(10);  // it takes a tenth of one
constexpr char kComplaint = '!';  // starts the message of an error

// One value per line, with tabs between its parts; names contain neither.
std::string ResolvedText(const link::LinkOptions& options) {
  try {
    std::ostringstream text;
    for (const link::ResolvedEntity& entity : link::ResolveQos(options)) {
      for (const link::ResolvedValue& value : entity.values) {
        text << entity.profile << '\t' << entity.topic << '\t' << value.policy << '\t'
             << value.number << '\n';
      }
    }
    return text.str();
  } catch (const std::exception& error) {
    return kComplaint + std::string(error.what());
  }
}

std::vector<link::ResolvedEntity> Understood(const std::string& text) {
  std::vector<link::ResolvedEntity> entities;
  std::istringstream lines(text);
  std::string profile, topic, policy, number;
  while (std::getline(lines, profile, '\t') && std::getline(lines, topic, '\t') &&
         std::getline(lines, policy, '\t') && std::getline(lines, number)) {
    if (entities.empty() || entities.back().profile != profile) {
      entities.push_back({profile, topic, {}});
    }
    entities.back().values.push_back({policy, std::stoll(number)});
  }
  return entities;
}

}  // namespace

std::vector<link::ResolvedEntity> ResolveQosInChild(const link::LinkOptions& options) {
  const auto [text, whole] = RunInChild([&] { return ResolvedText(options); }, kResolvePatience);
  if (!text.empty() && text.front() == kComplaint) throw link::LinkError(text.substr(1));
  if (!whole || text.empty()) {
    throw link::LinkError("QoS file " + options.qos.name +
                          ": the library crashed or hung on it; fleetctl "
                          "qos check says more");
  }
  return Understood(text);
}

}  // namespace giveway::fleetctl
