#include "services/link/sample_filter.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

#include "services/link/inbox/participant_of.h"
#include "services/link/inbox/silence_limit.h"

namespace giveway::link {
namespace {

constexpr std::size_t kMostKept = 4;       // refusals between two looks; the counter has all
constexpr std::size_t kPayloadHeader = 4;  // bytes of the encapsulation
constexpr const char* kTooMany = "it names more ids than one may";
constexpr std::string_view kExpression = "filter ";

std::uint64_t HashOf(const SessionId& session) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const std::uint32_t number : session) hash = (hash ^ number) * 0x100000001b3ULL;
  return hash;
}

std::uint32_t Number32(const std::uint8_t* bytes, bool little) {
  std::uint32_t number = 0;
  for (std::size_t byte = 0; byte < 4; ++byte) {
    number = number << 8U | bytes[little ? 3 - byte : byte];
  }
  return number;
}

void Follow(std::uint64_t participant, SteadyTime now, Speaker* speaker) {
  if (speaker->participant != participant) speaker->before = speaker->participant;
  speaker->participant = participant;
  speaker->heard = now;
}

}  // namespace

// A 2.9.1 that receives a dispose of another vendor's writer takes the bytes of its key for a
// hash, which then is of no key: dropped, and not counted.
KeyReader::KeyReader(const rtps::CacheChange_t& change, const FilterOfTopic& topic)
    : size_(std::min(topic.key_numbers, kMostNumbers)) {
  if (size_ == 0) return;  // one instance for all
  const bool has_instance = change.instanceHandle.isDefined() && !topic.digests;
  if (change.kind != rtps::ALIVE && has_instance) {
    known_ = ReadInstance(change.instanceHandle);
    if (!known_) why_not_ = "";
    return;
  }
  known_ = ReadPayload(change.serializedPayload);
  if (!known_) {
    if (change.kind == rtps::ALIVE) why_not_ = "it is too short for a key";
    return;
  }
  const std::array<std::uint32_t, kMostNumbers> own = numbers_;
  if (has_instance && (!ReadInstance(change.instanceHandle) || numbers_ != own)) {
    why_not_ = "its key hash is not of its key";
    numbers_ = own;
  }
}

bool KeyReader::ReadPayload(const rtps::SerializedPayload_t& payload) {
  if (payload.data == nullptr || payload.length < kPayloadHeader + 4 * size_) return false;
  const bool little = (payload.data[1] & 1U) != 0;
  for (std::size_t i = 0; i < size_; ++i) {
    numbers_[i] = Number32(payload.data + kPayloadHeader + 4 * i, little);
  }
  return true;
}

// The key in big-endian order, and zeros: keys of up to 16 bytes are no more than that.
bool KeyReader::ReadInstance(const rtps::InstanceHandle_t& instance) {
  const std::uint8_t* const bytes = instance.value;
  for (std::size_t i = 0; i < size_; ++i) numbers_[i] = Number32(bytes + 4 * i, false);
  return std::all_of(bytes + 4 * size_, bytes + 4 * kMostNumbers,
                     [](std::uint8_t byte) { return byte == 0; });
}

std::optional<VehicleId> KeyReader::Vehicle() const {
  if (!known_ || size_ != 1) return std::nullopt;
  return VehicleId{numbers_[0]};
}

std::optional<SessionId> KeyReader::Session() const {
  if (!known_ || size_ != kMostNumbers) return std::nullopt;
  return SessionId{numbers_};
}

bool SampleFilter::Passes(const rtps::CacheChange_t& change, const FilterOfTopic& topic,
                          SteadyTime now) {
  const std::scoped_lock lock(mutex_);
  const bool passes = Allows(change, topic, now);
  if (arrivals_ != nullptr && change.kind == rtps::ALIVE) {
    arrivals_->Note(Identity(change.writerGUID), change.sequenceNumber.to64long(), passes);
  }
  return passes;
}

bool SampleFilter::Allows(const rtps::CacheChange_t& change, const FilterOfTopic& topic,
                          SteadyTime now) {
  const KeyReader key(change, topic);
  const char* const wrong_key = key.WhyNot();
  const char* const why = wrong_key != nullptr ? wrong_key : WhyNot(change.writerGUID, key, now);
  if (why == nullptr) return true;
  if (*why == '\0') return false;
  refused_.fetch_add(1, std::memory_order_relaxed);
  if (kept_.size() < kMostKept) {
    kept_.push_back({.sample = sample_,
                     .vehicle = by_vehicle_ ? key.Vehicle().value_or(kNoVehicle) : kNoVehicle,
                     .writer = Identity(change.writerGUID),
                     .counter = "strangers",
                     .field = wrong_key != nullptr ? "key" : "writer",
                     .why = why});
  }
  return false;
}

void SampleFilter::TakeRefusals(std::vector<Refusal>* refusals) {
  const std::scoped_lock lock(mutex_);
  for (Refusal& refusal : kept_) refusals->push_back(std::move(refusal));
  kept_.clear();
}

bool KeysBySource::Admits(std::uint64_t source, std::uint64_t key) {
  const auto [entry, is_new] = keys_.try_emplace(source);
  std::vector<std::uint64_t>& known = entry->second;
  const bool admits = std::ranges::find(known, key) != known.end() || known.size() < most_;
  if (admits && (known.empty() || std::ranges::find(known, key) == known.end())) {
    known.push_back(key);
  }
  if (is_new) oldest_.push_back(source);
  for (; oldest_.size() > kMostSources; oldest_.pop_front()) keys_.erase(oldest_.front());
  return admits;
}

const char* KeyQuota::WhyNot(const rtps::GUID_t& writer, const KeyReader& key, SteadyTime) {
  std::uint64_t named = 0;
  if (key_ == Key::kVehicle) {
    const auto vehicle = key.Vehicle();
    if (!vehicle) return nullptr;
    named = Number(*vehicle);
  } else {
    const auto session = key.Session();
    if (!session) return nullptr;
    named = HashOf(*session);
  }
  const std::uint64_t source = of_ == Of::kWriter ? Identity(writer) : ParticipantOf(writer);
  return known_.Admits(source, named) ? nullptr : kTooMany;
}

void OwnerFilter::SetOwner(VehicleId vehicle, std::uint64_t participant) {
  const std::scoped_lock lock(Mutex());
  if (participant == 0) {
    owners_.erase(vehicle);
  } else {
    owners_[vehicle] = participant;
  }
}

std::uint64_t OwnerFilter::OwnerOf(VehicleId vehicle) {
  const std::scoped_lock lock(Mutex());
  const auto owner = owners_.find(vehicle);
  return owner == owners_.end() ? 0 : owner->second;
}

const char* OwnerFilter::WhyNot(const rtps::GUID_t& writer, const KeyReader& key, SteadyTime) {
  const auto vehicle = key.Vehicle();
  if (!vehicle) return nullptr;
  const auto owner = owners_.find(*vehicle);
  if (owner != owners_.end()) {
    return owner->second == ParticipantOf(writer) ? nullptr
                                                  : "another participant joined with this id";
  }
  return unowned_.Admits(Identity(writer), Number(*vehicle)) ? nullptr : kTooMany;
}

void FirstComerFilter::SetTickPeriod(Nanoseconds period) {
  const std::scoped_lock lock(Mutex());
  silence_ = SilenceLimit(kSilence, period);
}

bool FirstComerFilter::Spoke(VehicleId vehicle, std::uint64_t participant) {
  const std::scoped_lock lock(Mutex());
  const auto speaker = speakers_.find(vehicle);
  return speaker != speakers_.end() && speaker->second.Spoke(participant);
}

const char* FirstComerFilter::WhyNot(const rtps::GUID_t& writer, const KeyReader& key,
                                     SteadyTime now) {
  const auto vehicle = key.Vehicle();
  if (!vehicle) return nullptr;
  if (!named_.Admits(Identity(writer), Number(*vehicle))) return kTooMany;
  const std::uint64_t participant = ParticipantOf(writer);
  const auto [known, is_new] = speakers_.try_emplace(*vehicle);
  Speaker& speaker = known->second;
  if (!is_new && speaker.participant != participant && now - speaker.heard <= silence_) {
    return "another participant speaks for this id";
  }
  Follow(participant, now, &speaker);
  if (is_new) oldest_.push_back(*vehicle);
  for (; oldest_.size() > kMostSpeakers; oldest_.pop_front()) speakers_.erase(oldest_.front());
  return nullptr;
}

void FirstWorldFilter::SetTickPeriod(Nanoseconds period) {
  const std::scoped_lock lock(Mutex());
  silence_ = SilenceLimit(kSilence, period);
}

bool FirstWorldFilter::Spoke(std::uint64_t participant) {
  const std::scoped_lock lock(Mutex());
  return world_.Spoke(participant);
}

const char* FirstWorldFilter::WhyNot(const rtps::GUID_t& writer, const KeyReader&, SteadyTime now) {
  const std::uint64_t participant = ParticipantOf(writer);
  const bool other = world_.participant != 0 && world_.participant != participant;
  if (other && now - world_.heard <= silence_ && is_there_(world_.participant)) {
    return "another world is there";
  }
  Follow(participant, now, &world_);
  return nullptr;
}

void SessionFilter::Follow(const SessionId& session) {
  const std::scoped_lock lock(Mutex());
  session_ = session;
}

// Entries of other sessions are no fault: they are not counted.
const char* SessionFilter::WhyNot(const rtps::GUID_t&, const KeyReader& key, SteadyTime) {
  const auto session = key.Session();
  return !session || *session == session_ ? nullptr : "";
}

const char* WorldFilter::WhyNot(const rtps::GUID_t& writer, const KeyReader&, SteadyTime) {
  const std::uint64_t world = world_.load(std::memory_order_relaxed);
  return world == 0 || world == ParticipantOf(writer) ? nullptr : "its writer is not the world's";
}

// What either release passes for the sample's identity is not that of a received sample. But both
// ask about the payload within a change, which has the writer and the instance.
const rtps::CacheChange_t& ChangeOf(const dds::IContentFilter::SerializedPayload& payload) {
  static const std::ptrdiff_t payload_at = [] {
    const rtps::CacheChange_t change;
    return reinterpret_cast<const char*>(&change.serializedPayload) -
           reinterpret_cast<const char*>(&change);
  }();
  const char* const change = reinterpret_cast<const char*>(&payload) - payload_at;
  return *reinterpret_cast<const rtps::CacheChange_t*>(change);
}

std::string FilterFactory::Add(const FilterOfTopic& filter) {
  const std::scoped_lock lock(mutex_);
  filters_.emplace_back(filter);
  return std::string(kExpression) + std::to_string(filters_.size() - 1);
}

// Each once, for its reader.
ReturnCode FilterFactory::create_content_filter(const char*, const char*, const dds::TopicDataType*,
                                                const char* expression, const ParameterSeq&,
                                                dds::IContentFilter*& filter) {
  const std::scoped_lock lock(mutex_);
  const std::string_view text = expression == nullptr ? "" : expression;
  std::size_t number = filters_.size();
  if (text.starts_with(kExpression)) {
    std::from_chars(text.data() + kExpression.size(), text.data() + text.size(), number);
  }
  if (number >= filters_.size() || filters_[number].given) return ReturnCode{1};
  filters_[number].given = true;
  filter = &filters_[number];
  return ReturnCode{};
}

}  // namespace giveway::link
