// FNV-1a over the bits of what is added, in the order it is added. Two states with equal hashes
// are taken for equal; padding is never read because fields are added one by one.
#pragma once

#include <bit>
#include <cstdint>
#include <type_traits>

namespace giveway {

class StateHash {
 public:
  void Add(std::uint64_t bits) {
    for (int shift = 0; shift < 64; shift += 8) {
      value_ = (value_ ^ ((bits >> shift) & 0xffU)) * 0x100000001b3ULL;
    }
  }
  void Add(double value) { Add(std::bit_cast<std::uint64_t>(value)); }
  template <typename T>
  requires std::is_enum_v<T> || std::is_same_v<T, bool> || std::is_same_v<T, std::uint32_t> ||
      std::is_same_v<T, std::int64_t> || std::is_same_v<T, int>
  void Add(T value) { Add(static_cast<std::uint64_t>(value)); }
  std::uint64_t Value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace giveway
