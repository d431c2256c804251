// What a reader takes no notice of, before the library keeps it: a sample of a stranger then takes
// neither memory nor the place of an honest one in a history. The library asks a filter on its own
// threads, for each sample; what is refused is counted, and the last few refused are kept for the
// log.
//
// A key stands first in every wire type: the vehicle's id, or the 128 bits of a session. What the
// library stores a sample under may come with it, as a hash of the key: a sample whose hash is of
// another key is refused by every filter.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "services/link/fastdds/fastdds_version.h"
#include "services/link/inbox/arrival_log.h"
#include "services/link/link_clock.h"
#include "services/types/fleet_facts.h"
#include "services/types/refusal.h"
#include "services/types/time.h"

namespace giveway::link {

class SampleFilter;

// A filter at work for the readers of one topic.
struct FilterOfTopic {
  SampleFilter* filter = nullptr;  // none: everything passes
  std::size_t key_numbers = 1;     // see topics.h
  // Where payloads are encrypted the library stores samples under a digest of the key, from which
  // the key cannot be read. Only participants with certificates are heard there.
  bool digests = false;
};

// The key of a change: of its payload, or where it has none, of the instance it names.
class KeyReader {
 public:
  KeyReader(const rtps::CacheChange_t& change, const FilterOfTopic& topic);

  // Why what the library would store it under is not the key of what it says; null if it is.
  // Empty where nothing is to be said of it.
  const char* WhyNot() const { return why_not_; }
  // Nothing where the key is of another kind, or only a digest is known.
  std::optional<VehicleId> Vehicle() const;
  std::optional<SessionId> Session() const;

 private:
  static constexpr std::size_t kMostNumbers = 4;
  bool ReadPayload(const rtps::SerializedPayload_t& payload);
  bool ReadInstance(const rtps::InstanceHandle_t& instance);

  std::size_t size_;                                   // numbers of the topic's keys
  bool known_ = false;                                 // whether `numbers_` are read
  std::array<std::uint32_t, kMostNumbers> numbers_{};  // 0 beyond `size_`
  const char* why_not_ = nullptr;
};

class SampleFilter {
 public:
  // `sample` is how the log calls it: "motor command"; `by_vehicle`: its key is a vehicle's id.
  explicit SampleFilter(const char* sample, bool by_vehicle = true)
      : sample_(sample), by_vehicle_(by_vehicle) {}
  virtual ~SampleFilter() = default;
  SampleFilter(const SampleFilter&) = delete;
  SampleFilter& operator=(const SampleFilter&) = delete;

  // On the library's threads. `now` is of the clock that worlds are watched by.
  bool Passes(const rtps::CacheChange_t& change, const FilterOfTopic& topic, SteadyTime now);

  // From now on what arrives is noted there. It outlives this. Before the first sample.
  void LogArrivals(ArrivalLog* arrivals) { arrivals_ = arrivals; }

  std::uint32_t Refused() const { return refused_.load(std::memory_order_relaxed); }
  // The first few since the last call.
  void TakeRefusals(std::vector<Refusal>* refusals);

 protected:
  // Why it does not pass, empty where that is nothing to be said of, or null. One call at a time.
  virtual const char* WhyNot(const rtps::GUID_t& writer, const KeyReader& key, SteadyTime now) = 0;
  std::mutex& Mutex() { return mutex_; }  // held during WhyNot

 private:
  bool Allows(const rtps::CacheChange_t& change, const FilterOfTopic& topic, SteadyTime now);

  const char* const sample_;
  const bool by_vehicle_;
  ArrivalLog* arrivals_ = nullptr;
  std::mutex mutex_;
  std::vector<Refusal> kept_;  // guarded by mutex_
  std::atomic<std::uint32_t> refused_{0};
};

// The first few keys that each source names, and no more: of writers, or participants. Bounded.
class KeysBySource {
 public:
  static constexpr std::size_t kMostSources = 4096;  // beyond, the oldest are forgotten

  explicit KeysBySource(std::size_t most) : most_(most) {}
  // False of one key too many.
  bool Admits(std::uint64_t source, std::uint64_t key);

 private:
  const std::size_t most_;
  std::unordered_map<std::uint64_t, std::vector<std::uint64_t>> keys_;  // by source
  std::deque<std::uint64_t> oldest_;                                    // of keys_
};

// A writer speaks for one vehicle. A few ids more are let through, to be refused by name.
inline constexpr std::size_t kMostIdsOfWriter = 4;

// So many keys of each participant, the first that it names: one that names a hundred thousand
// makes no more instances than any other.
class KeyQuota final : public SampleFilter {
 public:
  enum class Key : std::uint8_t { kVehicle, kSession };
  enum class Of : std::uint8_t { kWriter, kParticipant };
  KeyQuota(const char* sample, Key key, Of of, std::size_t most)
      : SampleFilter(sample, key == Key::kVehicle), key_(key), of_(of), known_(most) {}

 private:
  const char* WhyNot(const rtps::GUID_t& writer, const KeyReader& key, SteadyTime now) override;

  const Key key_;
  const Of of_;
  KeysBySource known_;
};

// Only what the owner of a vehicle's id says for it; for ids without owner each writer for a few.
class OwnerFilter final : public SampleFilter {
 public:
  explicit OwnerFilter(const char* sample) : SampleFilter(sample) {}

  // From now on `participant` speaks for the vehicle; 0: no participant in particular.
  void SetOwner(VehicleId vehicle, std::uint64_t participant);
  std::uint64_t OwnerOf(VehicleId vehicle);

 private:
  const char* WhyNot(const rtps::GUID_t& writer, const KeyReader& key, SteadyTime now) override;

  std::unordered_map<VehicleId, std::uint64_t> owners_;
  KeysBySource unowned_{kMostIdsOfWriter};
};

// The participant that speaks for something: the first, until it has been silent. A packet may
// pretend that its writer has asked the filter already; the library then does not ask it. So what
// is read from a reader must be of one that Spoke.
struct Speaker {
  std::uint64_t participant = 0;
  std::uint64_t before = 0;  // whose place it took: what that one said may not have been read yet
  SteadyTime heard{0};

  bool Spoke(std::uint64_t one) const { return one != 0 && (one == participant || one == before); }
};

// Of the participants that speak for a vehicle the first, until it has been silent for a second, or
// for a few ticks where they are slow.
class FirstComerFilter final : public SampleFilter {
 public:
  explicit FirstComerFilter(const char* sample) : SampleFilter(sample) {}
  static constexpr Nanoseconds kSilence = std::chrono::seconds(1);

  // From one tick of the world to the next; 0: not known.
  void SetTickPeriod(Nanoseconds period);
  // Whether the participant is the one that passes for the vehicle, or was before that.
  bool Spoke(VehicleId vehicle, std::uint64_t participant);

 private:
  const char* WhyNot(const rtps::GUID_t& writer, const KeyReader& key, SteadyTime now) override;

  static constexpr std::size_t kMostSpeakers = 4096;  // beyond, the oldest are forgotten

  KeysBySource named_{kMostIdsOfWriter};
  Nanoseconds silence_ = kSilence;
  std::unordered_map<VehicleId, Speaker> speakers_;
  std::deque<VehicleId> oldest_;  // of speakers_
};

// Of participants that speak as the world the first, until it has left or is silent: for observers,
// which receive every body's pose from a world each tick. For all readers of the world's topics.
class FirstWorldFilter final : public SampleFilter {
 public:
  using IsThere = std::function<bool(std::uint64_t participant)>;
  FirstWorldFilter(const char* sample, IsThere is_there)
      : SampleFilter(sample, false), is_there_(std::move(is_there)) {}
  static constexpr Nanoseconds kSilence = std::chrono::milliseconds(500);

  void SetTickPeriod(Nanoseconds period);  // as above
  bool Spoke(std::uint64_t participant);   // as the world

 private:
  const char* WhyNot(const rtps::GUID_t& writer, const KeyReader& key, SteadyTime now) override;

  const IsThere is_there_;
  Nanoseconds silence_ = kSilence;
  Speaker world_;
};

// Only entries of one session.
class SessionFilter final : public SampleFilter {
 public:
  explicit SessionFilter(const char* sample) : SampleFilter(sample, false) {}
  void Follow(const SessionId& session);

 private:
  const char* WhyNot(const rtps::GUID_t& writer, const KeyReader& key, SteadyTime now) override;

  SessionId session_{};
};

// Only what the world says, once it is known which participant that is.
class WorldFilter final : public SampleFilter {
 public:
  // `world`: the participant, 0 while there is none. It outlives this.
  WorldFilter(const char* sample, const std::atomic<std::uint64_t>& world)
      : SampleFilter(sample, false), world_(world) {}

 private:
  const char* WhyNot(const rtps::GUID_t& writer, const KeyReader& key, SteadyTime now) override;

  const std::atomic<std::uint64_t>& world_;
};

// The library's own bases have no virtual destructor, and are never destroyed by them.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wnon-virtual-dtor"

// What a filter is asked about. `payload` is the one that the library asks a filter with.
const rtps::CacheChange_t& ChangeOf(const dds::IContentFilter::SerializedPayload& payload);

// Hands the filters of a participant's readers to the library. Its name is the participant's own:
// writers elsewhere know no such filter, and send all. Those of this participant are not to ask for
// one, see WriterQos; where one does all the same it gets none, on whatever thread.
class FilterFactory final : public dds::IContentFilterFactory {
 public:
  // The expression that stands for the filter.
  std::string Add(const FilterOfTopic& filter);

  ReturnCode create_content_filter(const char* filter_class, const char* type,
                                   const dds::TopicDataType* support, const char* expression,
                                   const ParameterSeq& parameters,
                                   dds::IContentFilter*& filter) override;
  ReturnCode delete_content_filter(const char*, dds::IContentFilter*) override {
    return ReturnCode{};
  }

 private:
  struct Asked final : dds::IContentFilter {
    explicit Asked(const FilterOfTopic& asked) : topic(asked) {}
    bool evaluate(const SerializedPayload& payload, const FilterSampleInfo&,
                  const GUID_t&) const override {
      return topic.filter->Passes(ChangeOf(payload), topic, LinkNow());
    }
    FilterOfTopic topic;
    bool given = false;
  };

  std::mutex mutex_;
  std::deque<Asked> filters_;  // at stable addresses; guarded by mutex_
};

#pragma GCC diagnostic pop

}  // namespace giveway::link
