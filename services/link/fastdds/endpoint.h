// Typed writers and readers: what Participant hands out. They own nothing; the participant deletes
// every entity it made.
#pragma once

#include <algorithm>
#include <chrono>
#include <utility>

#include "services/link/fastdds/loan.h"
#include "services/types/time.h"

namespace giveway::link {

inline Duration ToDuration(Nanoseconds duration) {
  const auto count = std::max<std::int64_t>(duration.count(), 0);
  return {static_cast<std::int32_t>(count / 1'000'000'000),
          static_cast<std::uint32_t>(count % 1'000'000'000)};
}

inline double ToMilliseconds(const Duration& duration) {
  return duration.seconds * 1e3 + duration.nanosec * 1e-6;
}

template <typename Wire>
class Writer {
 public:
  explicit Writer(dds::DataWriter& writer) : writer_(&writer) {}

  // False if the library refused the sample. It takes a pointer to non-const and never writes.
  bool Write(const Wire& sample) { return Ok(writer_->write(const_cast<Wire*>(&sample))); }
  // Removes what was written of the sample's instance: readers that join later do not receive it.
  bool Retire(const Wire& sample) {
    return Ok(writer_->unregister_instance(const_cast<Wire*>(&sample), dds::HANDLE_NIL));
  }
  // True once every matched reliable reader has every sample; false after `timeout`.
  bool WaitUntilHeard(Nanoseconds timeout) {
    return Ok(writer_->wait_for_acknowledgments(ToDuration(timeout)));
  }
  bool WaitUntilHeard(std::chrono::steady_clock::time_point until) {
    return WaitUntilHeard(Nanoseconds(until - std::chrono::steady_clock::now()));
  }
  bool HasReader() const {
    dds::PublicationMatchedStatus status;
    return Ok(writer_->get_publication_matched_status(status)) && status.current_count > 0;
  }
  dds::DataWriter& Entity() const { return *writer_; }

 private:
  dds::DataWriter* writer_;
};

template <typename Wire>
class Reader {
 public:
  explicit Reader(dds::DataReader& reader) : reader_(&reader) {}

  // Empties the reader, see loan.h.
  template <typename Visit>
  void TakeEach(Visit&& visit) {
    link::TakeEach<Wire>(*reader_, std::forward<Visit>(visit));
  }
  dds::DataReader& Entity() const { return *reader_; }

 private:
  dds::DataReader* reader_;
};

// Waits for data on one reader.
class DataWait {
 public:
  explicit DataWait(dds::DataReader& reader) {
    reader.get_statuscondition().set_enabled_statuses(dds::StatusMask::data_available());
    wait_set_.attach_condition(reader.get_statuscondition());
  }
  // True if there is data not yet taken; false after `timeout`.
  bool Wait(Nanoseconds timeout) { return Ok(wait_set_.wait(active_, ToDuration(timeout))); }

 private:
  dds::WaitSet wait_set_;
  dds::ConditionSeq active_;
};

}  // namespace giveway::link
