// The key that seals orders to a fleet. A fleet started here without one gets its own for as long
// as it runs, in a folder of this user alone: the account that started a fleet may give it orders,
// and no other.
#pragma once

#include <cstdint>
#include <string>

namespace giveway::fleetctl {

// Creates the key of the fleet on a domain, and removes it at the end.
class RunKey {
 public:
  // `given`: the operator's own file, which is used and not changed. Throws auth::KeyError.
  RunKey(const std::string& given, std::uint32_t domain);
  ~RunKey();
  RunKey(const RunKey&) = delete;
  RunKey& operator=(const RunKey&) = delete;

  const std::string& File() const { return file_; }

 private:
  std::string file_;
  bool is_own_ = false;
};

// The key for orders: from the file `given`, else of the fleet that was started on the domain here,
// else empty. Throws auth::KeyError.
std::string KeyToOrderWith(const std::string& given, std::uint32_t domain);

}  // namespace giveway::fleetctl
