// A type whose samples are the bytes that came, not decoded: for recording them unchanged. For two
// releases of Fast DDS, as fastdds_version.h.
#pragma once

#include <string>

#include "services/link/fastdds/fastdds_version.h"

namespace giveway::link {

// A sample of `Wire` as it was serialized: encapsulation header and CDR.
template <typename Wire>
struct Raw {
  std::string bytes;
};

// Of a keyed type the key is decoded all the same: the library keeps a history for each.
template <typename Wire, typename Generated>
class RawType final : public Generated {
 public:
  bool is_plain(GIVEWAY_IS_PLAIN_PARAMETERS) const override { return false; }

#if __has_include(<fastrtps/config.h>)
  bool deserialize(rtps::SerializedPayload_t* payload, void* sample) override {
    static_cast<Raw<Wire>*>(sample)->bytes.assign(reinterpret_cast<const char*>(payload->data),
                                                  payload->length);
    return true;
  }
  bool serialize(void* /*sample*/, rtps::SerializedPayload_t* /*payload*/) override {
    return false;  // nothing is written here
  }
  void* createData() override { return new Raw<Wire>; }
  void deleteData(void* sample) override { delete static_cast<Raw<Wire>*>(sample); }
  bool getKey(void* sample, rtps::InstanceHandle_t* handle, bool force_md5) override {
    auto& bytes = static_cast<Raw<Wire>*>(sample)->bytes;
    rtps::SerializedPayload_t payload;
    payload.data = reinterpret_cast<rtps::octet*>(bytes.data());
    payload.length = static_cast<std::uint32_t>(bytes.size());
    payload.max_size = payload.length;
    Wire decoded;
    const bool ok = plain_.deserialize(&payload, &decoded);
    payload.data = nullptr;  // not the payload's to free
    return ok && plain_.getKey(&decoded, handle, force_md5);
  }
#else
  bool deserialize(rtps::SerializedPayload_t& payload, void* sample) override {
    static_cast<Raw<Wire>*>(sample)->bytes.assign(reinterpret_cast<const char*>(payload.data),
                                                  payload.length);
    return true;
  }
  bool serialize(const void* const /*sample*/, rtps::SerializedPayload_t& /*payload*/,
                 dds::DataRepresentationId_t /*representation*/) override {
    return false;  // nothing is written here
  }
  void* create_data() override { return new Raw<Wire>; }
  void delete_data(void* sample) override { delete static_cast<Raw<Wire>*>(sample); }
  bool compute_key(rtps::SerializedPayload_t& payload, rtps::InstanceHandle_t& handle,
                   bool force_md5) override {
    Wire decoded;
    return plain_.deserialize(payload, &decoded) &&
           plain_.compute_key(static_cast<const void*>(&decoded), handle, force_md5);
  }
  bool compute_key(const void* const sample, rtps::InstanceHandle_t& handle,
                   bool force_md5) override {
    const auto& bytes = static_cast<const Raw<Wire>*>(sample)->bytes;
    rtps::SerializedPayload_t payload(static_cast<std::uint32_t>(bytes.size()));
    std::copy(bytes.begin(), bytes.end(), payload.data);
    payload.length = payload.max_size;
    return compute_key(payload, handle, force_md5);
  }
#endif

 private:
  CheckedType<Generated> plain_;
};

}  // namespace giveway::link
