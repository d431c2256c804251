// Records as Protobuf and back, and what a restarting process hands over. Fields of ours and of the
// schema are paired by their order; a pair that does not fit is our bug, and the first record
// written shows it.
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <limits>
#include <sstream>
#include <type_traits>

#include "recording.pb.h"
#include "services/recording/framed_stream.h"
#include "services/recording/recording.h"
#include "services/recording/recording_fields.h"
#include "services/types/check.h"

namespace giveway {
namespace {

namespace pb = google::protobuf;

constexpr std::string_view kResumeMark = "giveway-resume-1\n";  // the number counts formats
constexpr std::size_t kMostResumeBytes = 1024;                  // some 250 are written

// Half of what fits: the difference of any two times does not overflow.
constexpr std::int64_t kMostTime_ns = std::numeric_limits<std::int64_t>::max() / 2;

template <typename T>
constexpr bool kIsOptional = false;
template <typename T>
constexpr bool kIsOptional<std::optional<T>> = true;

template <typename T>
concept List = !std::same_as<T, std::string> && requires(T list) {
  list.begin();
  list.size();
};
template <typename T>
concept Growing = List<T> && requires(T list) {
  list.resize(1);
};

const pb::FieldDescriptor& FieldOf(const pb::Message& message, int index) {
  return *message.GetDescriptor()->field(index);
}

template <typename... Values>
void CheckCount(const pb::Message& message, const Values&...) {
  GIVEWAY_CHECK(message.GetDescriptor()->field_count() == static_cast<int>(sizeof...(Values)),
                message.GetDescriptor()->name());
}

class Encoder {
 public:
  explicit Encoder(pb::Message* message)
      : message_(*message), reflection_(*message->GetReflection()) {}

  template <typename... Values>
  void operator()(const Values&... values) {
    CheckCount(message_, values...);
    int index = 0;
    (Put(FieldOf(message_, index++), values), ...);
  }

 private:
  template <typename T>
  void Put(const pb::FieldDescriptor& field, const T& value) {
    if constexpr (kIsOptional<T>) {
      if (value) Put(field, *value);
    } else if constexpr (List<T>) {
      for (const auto& element : value) Put(field, element);
    } else if constexpr (std::is_class_v<T> && !std::is_same_v<T, std::string> &&
                         !std::is_same_v<T, Nanoseconds>) {
      Encoder inner(field.is_repeated() ? reflection_.AddMessage(&message_, &field)
                                        : reflection_.MutableMessage(&message_, &field));
      Visit(inner, value);
    } else {
      PutPlain(field, value);
    }
  }

  // Of one value: `add` where it is one of a list, else `set`.
  template <typename T>
  void Call(const pb::FieldDescriptor& field, const T& value, auto add, auto set) {
    if (field.is_repeated()) {
      (reflection_.*add)(&message_, &field, value);
    } else {
      (reflection_.*set)(&message_, &field, value);
    }
  }

  template <typename T>
  void PutPlain(const pb::FieldDescriptor& field, const T& value) {
    using R = pb::Reflection;
    if constexpr (std::is_same_v<T, double>) {
      Call(field, value, &R::AddDouble, &R::SetDouble);
    } else if constexpr (std::is_same_v<T, bool>) {
      Call(field, value, &R::AddBool, &R::SetBool);
    } else if constexpr (std::is_same_v<T, int>) {
      Call(field, value, &R::AddInt32, &R::SetInt32);
    } else if constexpr (std::is_same_v<T, std::uint64_t>) {
      Call(field, value, &R::AddUInt64, &R::SetUInt64);
    } else if constexpr (std::is_same_v<T, Nanoseconds>) {
      Call(field, value.count(), &R::AddInt64, &R::SetInt64);
    } else if constexpr (std::is_same_v<T, std::string>) {
      reflection_.SetString(&message_, &field, value);
    } else if (field.cpp_type() == pb::FieldDescriptor::CPPTYPE_ENUM) {
      Call(field, static_cast<int>(value), &R::AddEnumValue, &R::SetEnumValue);
    } else {  // uint32, and ids
      Call(field, static_cast<std::uint32_t>(value), &R::AddUInt32, &R::SetUInt32);
    }
  }

  pb::Message& message_;
  const pb::Reflection& reflection_;
};

class Decoder {
 public:
  // Notes in `sound` what cannot be.
  Decoder(const pb::Message& message, bool* sound)
      : message_(message), reflection_(*message.GetReflection()), sound_(*sound) {}

  template <typename... Values>
  void operator()(Values&... values) {
    CheckCount(message_, values...);
    int index = 0;
    (Get(FieldOf(message_, index++), &values), ...);
  }

 private:
  static constexpr int kSingle = -1;

  template <typename T>
  void Get(const pb::FieldDescriptor& field, T* value, int index = kSingle) {
    if constexpr (kIsOptional<T>) {
      if (reflection_.HasField(message_, &field)) Get(field, &value->emplace());
    } else if constexpr (List<T>) {
      GetList(field, value);
    } else if constexpr (std::is_class_v<T> && !std::is_same_v<T, std::string> &&
                         !std::is_same_v<T, Nanoseconds>) {
      Decoder inner(index == kSingle ? reflection_.GetMessage(message_, &field)
                                     : reflection_.GetRepeatedMessage(message_, &field, index),
                    &sound_);
      Visit(inner, *value);
    } else {
      GetPlain(field, value, index);
    }
  }

  template <typename T>
  void GetList(const pb::FieldDescriptor& field, T* list) {
    const auto size = static_cast<std::size_t>(reflection_.FieldSize(message_, &field));
    if constexpr (Growing<T>) list->resize(size);
    if (list->size() != size) {
      sound_ = false;
      return;
    }
    int index = 0;
    for (auto& element : *list) Get(field, &element, index++);
  }

  // Of one value: `at` where it is one of a list, else `get`.
  auto Call(const pb::FieldDescriptor& field, int index, auto at, auto get) const {
    return index == kSingle ? (reflection_.*get)(message_, &field)
                            : (reflection_.*at)(message_, &field, index);
  }

  template <typename T>
  void GetPlain(const pb::FieldDescriptor& field, T* value, int index) {
    using R = pb::Reflection;
    // Of an older recording, from before there was such a field: the value is what it was then.
    const bool optional = index == kSingle && field.has_optional_keyword();
    if (optional && !reflection_.HasField(message_, &field)) return;
    if constexpr (std::is_same_v<T, double>) {
      *value = Call(field, index, &R::GetRepeatedDouble, &R::GetDouble);
    } else if constexpr (std::is_same_v<T, bool>) {
      *value = Call(field, index, &R::GetRepeatedBool, &R::GetBool);
    } else if constexpr (std::is_same_v<T, int>) {
      *value = Call(field, index, &R::GetRepeatedInt32, &R::GetInt32);
    } else if constexpr (std::is_same_v<T, std::uint64_t>) {
      *value = Call(field, index, &R::GetRepeatedUInt64, &R::GetUInt64);
    } else if constexpr (std::is_same_v<T, Nanoseconds>) {
      const std::int64_t count = Call(field, index, &R::GetRepeatedInt64, &R::GetInt64);
      sound_ = sound_ && count >= -kMostTime_ns && count <= kMostTime_ns;
      *value = Nanoseconds{count};
    } else if constexpr (std::is_same_v<T, std::string>) {
      *value = reflection_.GetString(message_, &field);
    } else if (field.cpp_type() == pb::FieldDescriptor::CPPTYPE_ENUM) {
      const int number = Call(field, index, &R::GetRepeatedEnumValue, &R::GetEnumValue);
      const bool known = field.enum_type()->FindValueByNumber(number) != nullptr;
      sound_ = sound_ && known;
      *value = static_cast<T>(known ? number : 0);
    } else {
      *value = static_cast<T>(Call(field, index, &R::GetRepeatedUInt32, &R::GetUInt32));
    }
  }

  const pb::Message& message_;
  const pb::Reflection& reflection_;
  bool& sound_;
};

template <typename T>
std::optional<Record> Decoded(const pb::Message& message) {
  bool sound = true;
  Decoder decoder(message, &sound);
  T value;
  Visit(decoder, value);
  if (!sound) return std::nullopt;
  return Record(std::move(value));
}

}  // namespace

std::string ToBytes(const Record& record) {
  using Cases = schema::recording::Record;
  Cases message;
  const auto put = [](pb::Message* into, const auto& value) {
    Encoder encoder(into);
    Visit(encoder, value);
  };
  if (const auto* life = std::get_if<RecordedLife>(&record)) put(message.mutable_life(), *life);
  if (const auto* step = std::get_if<RecordedStep>(&record)) put(message.mutable_step(), *step);
  if (const auto* seat = std::get_if<RecordedReseat>(&record)) put(message.mutable_reseat(), *seat);
  if (const auto* end = std::get_if<RecordedEnd>(&record)) put(message.mutable_end(), *end);
  if (const auto* head = std::get_if<RecordedContinuation>(&record)) {
    put(message.mutable_continuation(), *head);
  }
  if (const auto* image = std::get_if<RecordedImage>(&record)) put(message.mutable_image(), *image);
  return message.SerializeAsString();
}

std::optional<Record> RecordFrom(std::string_view bytes) {
  using Cases = schema::recording::Record;
  Cases message;
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()) ||
      !message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    return std::nullopt;
  }
  switch (message.record_case()) {
    case Cases::kLife:
      return Decoded<RecordedLife>(message.life());
    case Cases::kStep:
      return Decoded<RecordedStep>(message.step());
    case Cases::kReseat:
      return Decoded<RecordedReseat>(message.reseat());
    case Cases::kEnd:
      return Decoded<RecordedEnd>(message.end());
    case Cases::kContinuation:
      return Decoded<RecordedContinuation>(message.continuation());
    case Cases::kImage:
      return Decoded<RecordedImage>(message.image());
    case Cases::RECORD_NOT_SET:
      break;
  }
  return std::nullopt;
}

std::string ToBytes(const Resumed& resumed) {
  schema::recording::Resumed message;
  Encoder encoder(&message);
  Visit(encoder, resumed);
  return std::string(kResumeMark) + Framed(message.SerializeAsString());
}

std::optional<Resumed> ResumedFrom(std::string_view bytes) {
  if (!bytes.starts_with(kResumeMark) || bytes.size() > kMostResumeBytes) return std::nullopt;
  std::istringstream stream(std::string(bytes.substr(kResumeMark.size())));
  std::string payload;
  schema::recording::Resumed message;
  const bool whole = ReadFrame(stream, &payload) == FrameEnd::kFrame &&
                     stream.peek() == std::istringstream::traits_type::eof();
  if (!whole || !message.ParseFromString(payload)) return std::nullopt;
  bool sound = true;
  Decoder decoder(message, &sound);
  Resumed resumed;
  Visit(decoder, resumed);
  if (!sound || (resumed.handover && !IsSound(*resumed.handover))) return std::nullopt;
  return resumed;
}

}  // namespace giveway
