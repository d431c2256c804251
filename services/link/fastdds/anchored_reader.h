// Drains a reader of many instances so that departed ones can be removed when it is safe. Two
// faults of Fast DDS, in 2.9.1 and 3.1.2, make that necessary where a reader has a deadline:
// - It goes on watching the deadline of an instance that is gone, for ever. It removes an instance
//   only in a take that finds it not alive, and one that was drained before it died is never found.
// - If it removes the very instance its timer is set for, it stops watching every deadline of the
//   reader ("Could not set next deadline in the history").
// So of a living instance all samples are taken but one, its anchor, by which it can be found
// later; and one that is not alive is only read. RemoveDeparted removes those, and is to be called
// from the callback of a missed deadline: there it is known which instance the timer is set for.
#pragma once

#include <cstdint>
#include <limits>
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
    LeaveAnchors(visit);
    if (depth_ >= kLeastDepth) ReadAll(dds::NEW_VIEW_STATE, dds::ALIVE_INSTANCE_STATE, visit);
    TakeLiving(visit);
    ReadAll(dds::ANY_VIEW_STATE, dds::NOT_ALIVE_INSTANCE_STATE, visit);
  }
  dds::DataReader& Entity() const { return reader_; }

 private:
  // A history of one sample has no room for another beside the anchor.
  static constexpr std::int32_t kLeastDepth = 2;

  Loan<Wire> OfInstance(const dds::InstanceHandle_t& instance, dds::SampleStateMask state,
                        std::int32_t most) {
    return Loan<Wire>(reader_, [&](auto& samples, auto& infos) {
      return reader_.read_instance(samples, infos, most, instance, state);
    });
  }

  template <typename Visit>
  void LeaveAnchors(Visit&& visit) {
    std::erase_if(bare_, [&](const dds::InstanceHandle_t& instance) {
      const Loan<Wire> anchor = OfInstance(instance, dds::READ_SAMPLE_STATE, 1);
      if (anchor.Size() > 0 || IsUnknownInstance(anchor.Code())) return true;
      const Loan<Wire> fresh = OfInstance(instance, dds::NOT_READ_SAMPLE_STATE, 1);
      if (fresh.Size() == 0) return false;
      if (fresh.Info(0).valid_data) visit(fresh.Sample(0), fresh.Info(0));
      return true;
    });
  }

  template <typename Visit>
  void TakeLiving(Visit&& visit) {
    dds::InstanceHandle_t last;
    std::int32_t in_a_row = 0;
    while (true) {
      const Loan<Wire> loan(reader_, [&](auto& samples, auto& infos) {
        return reader_.take(samples, infos, dds::LENGTH_UNLIMITED, dds::NOT_READ_SAMPLE_STATE,
                            dds::ANY_VIEW_STATE, dds::ALIVE_INSTANCE_STATE);
      });
      if (loan.Size() == 0) return;
      for (int i = 0; i < loan.Size(); ++i) {
        const dds::SampleInfo& info = loan.Info(i);
        in_a_row = info.instance_handle == last ? in_a_row + 1 : 1;
        last = info.instance_handle;
        NoteTaken(info, in_a_row);
        if (info.valid_data) visit(loan.Sample(i), info);
      }
    }
  }

  // One that came a moment ago has no anchor yet; that of another has been overwritten where all
  // that the history holds is new.
  void NoteTaken(const dds::SampleInfo& info, std::int32_t in_a_row) {
    if (depth_ < kLeastDepth) return;
    if (info.view_state == dds::NEW_VIEW_STATE || in_a_row >= depth_) {
      bare_.insert(info.instance_handle);
    }
  }

  // Leaves one sample of each behind.
  template <typename Visit>
  void ReadAll(dds::ViewStateMask view, dds::InstanceStateMask state, Visit&& visit) {
    std::set<dds::InstanceHandle_t> instances;
    while (true) {
      const Loan<Wire> loan(reader_, [&](auto& samples, auto& infos) {
        return reader_.read(samples, infos, dds::LENGTH_UNLIMITED, dds::NOT_READ_SAMPLE_STATE, view,
                            state);
      });
      if (loan.Size() == 0) break;
      for (int i = 0; i < loan.Size(); ++i) {
        instances.insert(loan.Info(i).instance_handle);
        if (loan.Info(i).valid_data) visit(loan.Sample(i), loan.Info(i));
      }
    }
    for (const dds::InstanceHandle_t& instance : instances) KeepOne(instance);
  }

  // A full history refuses what is older than all it holds, by the writers' clocks: one that comes
  // back with an earlier clock would not be heard.
  void KeepOne(const dds::InstanceHandle_t& instance) {
    const std::int32_t more =
        OfInstance(instance, dds::READ_SAMPLE_STATE, dds::LENGTH_UNLIMITED).Size() - 1;
    if (more < 1) return;
    const Loan<Wire> taken(reader_, [&](auto& samples, auto& infos) {
      return reader_.take_instance(samples, infos, more, instance, dds::READ_SAMPLE_STATE);
    });
  }

  dds::DataReader& reader_;
  std::int32_t depth_ = std::numeric_limits<std::int32_t>::max();
  std::set<dds::InstanceHandle_t> bare_;  // living, and without an anchor
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

}  // namespace giveway::link
