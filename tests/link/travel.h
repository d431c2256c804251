// Takes a value over the wire without a network: through the type support that endpoints use.
#pragma once

#include <gtest/gtest.h>

#include "services/link/convert/convert.h"
#include "services/link/fastdds/topics.h"

namespace giveway::test {

// `sample` serialized and deserialized.
template <typename Wire>
Wire Travelled(Wire sample) {
  typename link::TopicOf<Wire>::Type type;
  link::rtps::SerializedPayload_t payload(link::SerializedSize(type, &sample));
  EXPECT_TRUE(link::Serialize(type, &sample, payload));
  Wire arrived;
  EXPECT_TRUE(link::Deserialize(type, payload, &arrived));
  return arrived;
}

inline bool IsReadable(bool readable) { return readable; }
inline bool IsReadable(link::Arrival arrival) { return arrival.readable; }

template <typename Ours>
Ours RoundTrip(const Ours& value) {
  Ours back;
  EXPECT_TRUE(IsReadable(link::FromWire(Travelled(link::ToWire(value)), back)));
  return back;
}

}  // namespace giveway::test
