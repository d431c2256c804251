#include "services/link/qos_trial.h"

#include "services/link/participant.h"

namespace giveway::link {
namespace {

constexpr char kPartition[] = "trial";

class Unheard final : public DiscoveryListener {
 public:
  void OnWriter(Change, const rtps::GUID_t&, const std::vector<std::string>&) override {}
};

template <typename... Wires>
void MakeEndpoints(Participant& participant) {
  (participant.MakeWriter<Wires>(kPartition), ...);
  (participant.MakeReader<Wires>(kPartition), ...);
}

}  // namespace

void TryQos(const LinkOptions& options) {
  LinkOptions plain = options;
  plain.impairment = {};
  Unheard unheard;
  Participant participant(plain, "giveway-qos-trial", unheard);
  participant.StandApart();
  MakeEndpoints<wire::Beacon, wire::MotorCommand, wire::Status, wire::Order, wire::Answer,
                wire::Join, wire::RangeScan, wire::RadarScan, wire::LidarScan, wire::CameraScan,
                wire::PoseFix, wire::SignalState, wire::Roster, wire::Truth, wire::Event,
                wire::Figures>(participant);
}

}  // namespace giveway::link
