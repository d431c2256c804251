// What a recorder has given of the topics whose writers keep their newest samples: they give those
// again to its next participant. Bounded: of more writers the first are forgotten. Pure.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <iterator>

namespace giveway::link {

class GivenSamples {
 public:
  static constexpr std::size_t kMostWriters = 1024;

  // From here on what was given so far comes again.
  void Renew() {
    for (Writer& writer : writers_) writer.before = writer.last;
  }
  // True where it was given before the last Renew. A writer's samples may come in any order, for
  // those of its instances come one after another.
  bool IsGivenAgain(std::size_t topic, std::uint64_t writer, std::uint64_t sequence) {
    const auto same = [&](const Writer& one) { return one.id == writer && one.topic == topic; };
    auto known = std::ranges::find_if(writers_, same);
    if (known == writers_.end()) {
      if (writers_.size() >= kMostWriters) writers_.pop_front();
      writers_.push_back({topic, writer});
      known = std::prev(writers_.end());
    }
    known->last = std::max(known->last, sequence);
    return sequence <= known->before;
  }
  std::size_t Writers() const { return writers_.size(); }

 private:
  struct Writer {
    std::size_t topic = 0;
    std::uint64_t id = 0;
    std::uint64_t last = 0;    // the highest number so far
    std::uint64_t before = 0;  // the last Renew
  };
  std::deque<Writer> writers_;
};

}  // namespace giveway::link
