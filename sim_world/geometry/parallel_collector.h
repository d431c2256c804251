// A list made in blocks, perhaps on several threads, and read as one: the same list however the
// work was cut. Allocates nothing once it has grown.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "services/types/parallel.h"

namespace giveway::sim {

template <typename T>
class ParallelCollector {
 public:
  // fill(i, list) for every i below `count`, each appending to a list; afterwards All() has what
  // was appended, in the order of i.
  template <typename Fill>
  void Make(std::size_t count, const ParallelFor& parallel, const Fill& fill) {
    const std::size_t blocks = (count + kBlock - 1) / kBlock;
    if (blocks_.size() < blocks) blocks_.resize(blocks);
    const auto make = [&](std::size_t begin, std::size_t end) {
      for (; begin != end; ++begin) {
        std::vector<T>& block = blocks_[begin];
        block.clear();
        const std::size_t past = std::min(count, (begin + 1) * kBlock);
        for (std::size_t i = begin * kBlock; i < past; ++i) fill(i, &block);
      }
    };
    parallel(blocks, std::ref(make));  // a reference, so that nothing is allocated
    all_.clear();
    for (std::size_t i = 0; i < blocks; ++i) {
      all_.insert(all_.end(), blocks_[i].begin(), blocks_[i].end());
    }
  }

  std::span<T> All() { return all_; }
  std::span<const T> All() const { return all_; }

 private:
  static constexpr std::size_t kBlock = 64;

  std::vector<std::vector<T>> blocks_;
  std::vector<T> all_;
};

}  // namespace giveway::sim
