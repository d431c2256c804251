// Orders and their answers. The live values travel as text: there are some two hundred of them,
// their names change with the profiles, and the topic is not on a hot path.
#include <charconv>

#include "services/link/convert/convert.h"
#include "services/link/convert/convert_parts.h"

namespace giveway::link {
namespace {

std::string LinesOf(const std::vector<LiveValue>& values) {
  std::string lines;
  for (const LiveValue& value : values) {
    const std::string line =
        value.profile + '\t' + value.policy + '\t' + std::to_string(value.number) + '\n';
    if (lines.size() + line.size() > QosProfiles::kMostBytes) break;
    lines += line;
  }
  return lines;
}

// False if a line is none of ours.
bool FromLine(std::string_view line, LiveValue& value) {
  const std::size_t first = line.find('\t');
  const std::size_t second = line.find('\t', first + 1);
  if (first == std::string_view::npos || second == std::string_view::npos) return false;
  value.profile = line.substr(0, first);
  value.policy = line.substr(first + 1, second - first - 1);
  const std::string_view number = line.substr(second + 1);
  const auto read = std::from_chars(number.begin(), number.end(), value.number);
  return read.ec == std::errc() && read.ptr == number.end();
}

bool FromLines(std::string_view lines, std::vector<LiveValue>& values) {
  values.clear();
  while (!lines.empty()) {
    const std::size_t end = lines.find('\n');
    if (end == std::string_view::npos || !FromLine(lines.substr(0, end), values.emplace_back())) {
      return false;
    }
    lines.remove_prefix(end + 1);
  }
  return true;
}

}  // namespace

wire::Order ToWire(const AdminRequest& order) {
  wire::Order sent;
  sent.vehicle(Number(order.vehicle));
  sent.number(order.number);
  sent.kind(ToWireEnum<wire::OrderKind>(order.kind));
  sent.name(CutText(order.profiles.name));
  sent.profiles(CutText(order.profiles.text, QosProfiles::kMostBytes));
  sent.seal(order.seal);
  return sent;
}

bool FromWire(const wire::Order& sample, AdminRequest& order) {
  order.vehicle = VehicleId{sample.vehicle()};
  order.number = sample.number();
  order.profiles = {sample.name().c_str(), sample.profiles().c_str()};
  order.seal = sample.seal();
  return FromWireEnum(sample.kind(), giveway::AdminRequestKind::kKeepRing, order.kind);
}

wire::Answer ToWire(const AdminAnswer& answer) {
  wire::Answer sent;
  sent.vehicle(Number(answer.vehicle));
  sent.order(answer.order);
  sent.state(ToWireEnum<wire::AnswerState>(answer.state));
  sent.reason(CutText(answer.reason));
  sent.fleet_size(answer.fleet_size);
  sent.network_interface(CutText(answer.interface));
  sent.name(CutText(answer.profiles.name));
  sent.profiles(CutText(answer.profiles.text, QosProfiles::kMostBytes));
  sent.live(LinesOf(answer.live));
  sent.seal(answer.seal);
  return sent;
}

bool FromWire(const wire::Answer& sample, AdminAnswer& answer) {
  answer.vehicle = VehicleId{sample.vehicle()};
  answer.order = sample.order();
  answer.reason = sample.reason().c_str();
  answer.fleet_size = sample.fleet_size();
  answer.interface = sample.network_interface().c_str();
  answer.profiles = {sample.name().c_str(), sample.profiles().c_str()};
  answer.seal = sample.seal();
  const bool state_known =
      FromWireEnum(sample.state(), giveway::AnswerState::kRefused, answer.state);
  return FromLines(sample.live().c_str(), answer.live) && state_known;
}

}  // namespace giveway::link
