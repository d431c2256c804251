#include "services/link/packet_filter/arrival_window.h"

#include <algorithm>

namespace giveway::link {

bool ArrivalWindow::Take(std::int64_t number, std::size_t bytes) {
  if (number <= unbroken_) return true;  // the library ignores it
  const auto place = static_cast<std::uint64_t>(number - unbroken_ - 1);
  if (place >= kAhead) return false;
  if (place > 0 && !beyond_[place]) {
    if (held_ + bytes > kMostHeld) return false;
    held_ += bytes;
  }
  beyond_.set(place);
  Fill();
  return true;
}

bool ArrivalWindow::MaySkip(std::int64_t first, std::int64_t last) const {
  return first <= unbroken_ + 1 || last <= unbroken_ + kGapAhead;
}

void ArrivalWindow::Skip(std::int64_t first, std::int64_t last) {
  if (last <= unbroken_) return;
  if (first <= unbroken_ + 1) {
    const std::int64_t step = last - unbroken_;
    beyond_ >>= static_cast<std::size_t>(std::min<std::int64_t>(step, kAhead));
    unbroken_ = last;
  } else {
    const std::int64_t end = std::min<std::int64_t>(last - unbroken_, kAhead);
    for (std::int64_t place = first - unbroken_ - 1; place < end; ++place) {
      beyond_.set(static_cast<std::size_t>(place));
    }
  }
  Fill();
}

void ArrivalWindow::Acknowledge(std::int64_t last, std::uint32_t count) {
  if (last >= unbroken_) {
    behind_ = -1;
    Skip(1, last);
  } else if (last != behind_ || count == behind_count_) {
    behind_ = last;
    behind_count_ = count;
  } else {
    const std::int64_t step = unbroken_ - last;
    beyond_ <<= static_cast<std::size_t>(std::min<std::int64_t>(step, kAhead));
    unbroken_ = last;
    behind_ = -1;
  }
}

void ArrivalWindow::Hear(std::int64_t first, std::uint32_t count) {
  if (count <= heartbeat_) return;
  heartbeat_ = count;
  Skip(1, first - 1);
}

void ArrivalWindow::Fill() {
  for (; beyond_[0]; ++unbroken_) beyond_ >>= 1;
  if (beyond_.none()) held_ = 0;
}

}  // namespace giveway::link
