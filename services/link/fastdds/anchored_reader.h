// Drains a reader of many instances so that departed ones can be removed when it is safe. Two
// faults of Fast DDS, in 2.9.1 and 3.1.2, make that necessary where a reader has a deadline:
// - It keeps watching the deadline of a departed instance for ever. It removes an instance only in
//   a take that finds it not alive, and one that was drained before it died is never found.
// - If it removes the very instance its timer is set for, it stops watching every deadline of the
//   reader ("Could not set next deadline in the history").
// So what is read stays in the reader until there is more of it: each instance keeps a sample from
// its first on, its anchor, by which it can be found later. RemoveDeparted removes those that are
// not alive, and is to be called from the callback of a missed deadline: there it is known which
// instance the timer is set for.
#pragma once

#include <algorithm>
#include <cstdint>
#include <set>

#include "services/link/fastdds/endpoint.h"

namespace giveway::link {

template <typename Wire>
class AnchoredReader {
 public:
  explicit AnchoredReader(Reader<Wire> reader) : reader_(reader.Entity()) {
    const auto& history = reader_.get_qos().history();
    if (history.kind == dds::KEEP_LAST_HISTORY_QOS) depth_ = history.depth;
  }

  // As Reader::TakeEach.
  template <typename Visit>
  void TakeEach(Visit&& visit) {
    if (depth_ < kLeastDepth) {
      TakeLiving(visit);
      ReadAll(dds::NOT_ALIVE_INSTANCE_STATE, visit);
    } else {
      ReadAll(dds::ANY_INSTANCE_STATE, visit);
    }
    if (most_held_ + 1 >= std::min(depth_, kMostHeld)) KeepAnchors();
  }
  // Removes what is gone from a reader without a deadline, at every 32nd turn; with one its
  // listener does that, which alone knows when it may.
  void ForgetDeparted();
  dds::DataReader& Entity() const { return reader_; }

 private:
  static constexpr std::uint32_t kForgetEvery = 32;  // turns
  // A history of one sample cannot hold another next to the anchor.
  static constexpr std::int32_t kLeastDepth = 2;
  // The library looks through all that a reader holds for each sample that comes or is taken.
  static constexpr std::int32_t kMostHeld = 8;

  Loan<Wire> OfInstance(const dds::InstanceHandle_t& instance, dds::SampleStateMask state,
                        std::int32_t most) {
    return Loan<Wire>(reader_, [&](auto& samples, auto& infos) {
      return reader_.read_instance(samples, infos, most, instance, state);
    });
  }

  template <typename Visit>
  void TakeLiving(Visit&& visit) {
    while (true) {
      const Loan<Wire> loan(reader_, [&](auto& samples, auto& infos) {
        return reader_.take(samples, infos, dds::LENGTH_UNLIMITED, dds::NOT_READ_SAMPLE_STATE,
                            dds::ANY_VIEW_STATE, dds::ALIVE_INSTANCE_STATE);
      });
      if (loan.Size() == 0) return;
      VisitEach(loan, visit);
    }
  }

  template <typename Visit>
  void ReadAll(dds::InstanceStateMask state, Visit&& visit) {
    std::int32_t most = 0;
    while (true) {
      const Loan<Wire> loan(reader_, [&](auto& samples, auto& infos) {
        return reader_.read(samples, infos, dds::LENGTH_UNLIMITED, dds::NOT_READ_SAMPLE_STATE,
                            dds::ANY_VIEW_STATE, state);
      });
      if (loan.Size() == 0) break;
      most += VisitEach(loan, visit);
      for (int i = 0; i < loan.Size(); ++i) read_.insert(loan.Info(i).instance_handle);
    }
    most_held_ = std::min(most_held_ + most, depth_);
  }

  // Returns the most samples of one instance.
  template <typename Visit>
  static std::int32_t VisitEach(const Loan<Wire>& loan, Visit&& visit) {
    std::int32_t in_a_row = 0;
    std::int32_t most = 0;
    for (int i = 0; i < loan.Size(); ++i) {
      const bool goes_on =
          i > 0 && loan.Info(i).instance_handle == loan.Info(i - 1).instance_handle;
      in_a_row = goes_on ? in_a_row + 1 : 1;
      most = std::max(most, in_a_row);
      if (loan.Info(i).valid_data) visit(loan.Sample(i), loan.Info(i));
    }
    return most;
  }

  // A full history refuses what is older than all it holds, by the writers' clocks: one that comes
  // back with an earlier clock would not be heard. So none gets full of what has been read.
  void KeepAnchors() {
    for (const dds::InstanceHandle_t& instance : read_) KeepOne(instance);
    read_.clear();
    most_held_ = 1;
  }

  void KeepOne(const dds::InstanceHandle_t& instance) {
    const std::int32_t more =
        OfInstance(instance, dds::READ_SAMPLE_STATE, dds::LENGTH_UNLIMITED).Size() - 1;
    if (more < 1) return;
    const Loan<Wire> taken(reader_, [&](auto& samples, auto& infos) {
      return reader_.take_instance(samples, infos, more, instance, dds::READ_SAMPLE_STATE);
    });
  }

  dds::DataReader& reader_;
  std::int32_t depth_ = kLeastDepth;      // of a history that keeps all: trimmed at every turn
  std::set<dds::InstanceHandle_t> read_;  // since anchors were all that is kept
  std::int32_t most_held_ = 1;            // of one instance, at most, of what has been read
  std::uint32_t turns_ = 0;
};

// Removes the instances of a reader that are not alive and were drained by AnchoredReader, all but
// `kept`: the one that a deadline's timer is set for.
template <typename Wire>
void RemoveDeparted(dds::DataReader& reader, const dds::InstanceHandle_t& kept) {
  constexpr int kMostTurns = 32;  // of 32 samples: the callback holds up the library's timers
  for (int turn = 0; turn < kMostTurns; ++turn) {
    std::set<dds::InstanceHandle_t> departed;
    {
      const Loan<Wire> loan(reader, [&](auto& samples, auto& infos) {
        return reader.read(samples, infos, dds::LENGTH_UNLIMITED, dds::READ_SAMPLE_STATE,
                           dds::ANY_VIEW_STATE, dds::NOT_ALIVE_INSTANCE_STATE);
      });
      for (int i = 0; i < loan.Size(); ++i) departed.insert(loan.Info(i).instance_handle);
    }
    departed.erase(kept);
    if (departed.empty()) return;
    for (const dds::InstanceHandle_t& instance : departed) {
      const Loan<Wire> taken(reader, [&](auto& samples, auto& infos) {
        return reader.take_instance(samples, infos, dds::LENGTH_UNLIMITED, instance,
                                    dds::READ_SAMPLE_STATE, dds::ANY_VIEW_STATE,
                                    dds::NOT_ALIVE_INSTANCE_STATE);
      });
    }
  }
}

template <typename Wire>
void AnchoredReader<Wire>::ForgetDeparted() {
  if (++turns_ % kForgetEvery != 0) return;
  const Duration none = dds::DeadlineQosPolicy().period;
  if (reader_.get_qos().deadline().period.seconds != none.seconds) return;
  RemoveDeparted<Wire>(reader_, dds::HANDLE_NIL);
}

}  // namespace giveway::link
