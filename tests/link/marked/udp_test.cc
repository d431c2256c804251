// Over UDP the packet filter drops what says that its writer has asked the reader's filter already:
// the library would keep the sample without asking it.
#include <gtest/gtest.h>

#include "services/link/convert/convert.h"
#include "services/link/fastdds/packets_of_process.h"
#include "services/link/observer_link.h"
#include "services/link/world_link.h"
#include "tests/link/marked/marked.h"

namespace giveway::test {
namespace {

TEST(MarkedAsFiltered, ASampleOverUdpDoesNotReachTheLibrary) {
  const DomainLock domain;
  link::WorldLink world(OptionsIn(domain));
  link::ObserverLink observer(OptionsIn(domain));
  Marked<wire::Truth> intruder(OptionsIn(domain), link::kWorldPartition);
  const auto dropped = [] { return link::PacketsOfProcess().Of(PacketDrop::kMalformed); };
  const std::uint64_t before = dropped();
  ASSERT_TRUE(Eventually([&] {
    Truth lie;
    lie.vehicle = VehicleId{7};
    lie.epoch = WorldEpoch{1};
    const bool marked = intruder.Write(link::ToWire(lie));
    return marked && dropped() > before + 10;
  }));
}

// An expression of a stranger's reader would be parsed by every writer, and asked for each sample.
TEST(Writers, FilterForNoReader) {
  const DomainLock domain;
  Unnamed listener;
  link::Participant participant(OptionsIn(domain), "any", listener);
  const auto writer = participant.MakeWriter<wire::Beacon>("main/v7");
  EXPECT_EQ(writer.Entity().get_qos().writer_resource_limits().reader_filters_allocation.maximum,
            0U);
}

}  // namespace
}  // namespace giveway::test
