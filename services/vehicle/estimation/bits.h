// The set bits of a word, lowest first, for a range-based for: of 16 sensors few hear something,
// and of 48 cells few hold anything.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace giveway {

class BitsOf {
 public:
  explicit constexpr BitsOf(std::uint64_t word) : word_(word) {}

  class Iterator {
   public:
    explicit constexpr Iterator(std::uint64_t left) : left_(left) {}
    constexpr std::size_t operator*() const {
      return static_cast<std::size_t>(std::countr_zero(left_));
    }
    constexpr Iterator& operator++() {
      left_ &= left_ - 1;
      return *this;
    }
    constexpr bool operator!=(const Iterator& other) const { return left_ != other.left_; }

   private:
    std::uint64_t left_;
  };

  constexpr Iterator begin() const { return Iterator(word_); }
  constexpr Iterator end() const { return Iterator(0); }

 private:
  std::uint64_t word_;
};

}  // namespace giveway
