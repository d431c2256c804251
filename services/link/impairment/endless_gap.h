// A packet that would keep the library busy for hours: a GAP that says of billions of samples that
// they will not come. Fast DDS up to 3.1 steps through them one by one, under the locks that all
// receiving threads need. No sound sender writes one, but one flipped bit makes it of a sound GAP,
// and only the checksum of UDP, which an impairment comes behind, keeps it out.
#pragma once

#include <cstdint>
#include <span>

namespace giveway::link {

bool HasEndlessGap(std::span<const std::uint8_t> packet);

}  // namespace giveway::link
