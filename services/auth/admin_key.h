// The shared secret of a fleet's operators: a file, the same for each service and for fleetctl.
#pragma once

#include <stdexcept>
#include <string>

namespace giveway::auth {

inline constexpr std::size_t kLeastKeyBytes = 16;
inline constexpr std::size_t kMostKeyBytes = 4096;

class KeyError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The bytes of the file but for white space at its end, kLeastKeyBytes to kMostKeyBytes. Throws
// KeyError.
std::string ReadAdminKey(const std::string& file);

// Makes the file with 256 random bits in hexadecimal, readable by this user alone. One that is
// there is replaced. Throws KeyError.
void MakeAdminKey(const std::string& file);

}  // namespace giveway::auth
