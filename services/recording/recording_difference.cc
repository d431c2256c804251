// Where two outputs differ, in the words of the schema.
#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <bit>

#include "recording.pb.h"
#include "services/recording/recording.h"
#include "services/types/check.h"

namespace giveway {
namespace {

namespace pb = google::protobuf;

std::string BytesOf(const Outputs& outputs) {
  RecordedStep step;
  step.outputs = outputs;
  return ToBytes(step);
}

schema::recording::Outputs MessageOf(const std::string& bytes) {
  schema::recording::Record record;
  const bool parsed = record.ParseFromString(bytes);
  GIVEWAY_CHECK(parsed);
  return record.step().outputs();
}

// One field that is neither a message nor a list.
struct Plain {
  std::uint64_t bits = 0;
  std::string text;
};

Plain PlainOf(const pb::Message& message, const pb::FieldDescriptor& field) {
  const pb::Reflection& reflection = *message.GetReflection();
  switch (field.cpp_type()) {
    case pb::FieldDescriptor::CPPTYPE_DOUBLE: {
      const double value = reflection.GetDouble(message, &field);
      return {std::bit_cast<std::uint64_t>(value), fmt::format("{}", value)};
    }
    case pb::FieldDescriptor::CPPTYPE_BOOL: {
      const bool value = reflection.GetBool(message, &field);
      return {value, fmt::format("{}", value)};
    }
    case pb::FieldDescriptor::CPPTYPE_INT32: {
      const std::int32_t value = reflection.GetInt32(message, &field);
      return {static_cast<std::uint32_t>(value), fmt::format("{}", value)};
    }
    case pb::FieldDescriptor::CPPTYPE_ENUM: {
      const auto* value = reflection.GetEnum(message, &field);
      return {static_cast<std::uint32_t>(value->number()), value->name()};
    }
    default: {
      const std::uint32_t value = reflection.GetUInt32(message, &field);
      return {value, fmt::format("{}", value)};
    }
  }
}

std::optional<FieldDifference> FirstOf(const pb::Message& recorded, const pb::Message& replayed,
                                       const std::string& path) {
  const pb::Descriptor& type = *recorded.GetDescriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const pb::FieldDescriptor& field = *type.field(i);
    const std::string name = path + field.name();
    if (field.cpp_type() == pb::FieldDescriptor::CPPTYPE_MESSAGE) {
      const pb::Reflection& reflection = *recorded.GetReflection();
      if (auto inner = FirstOf(reflection.GetMessage(recorded, &field),
                               reflection.GetMessage(replayed, &field), name + ".")) {
        return inner;
      }
      continue;
    }
    const Plain one = PlainOf(recorded, field);
    const Plain other = PlainOf(replayed, field);
    if (one.bits != other.bits) return FieldDifference{name, one.text, other.text};
  }
  return std::nullopt;
}

}  // namespace

// Equal bytes are equal bits: a message is written in one way only.
std::optional<FieldDifference> FirstDifference(const Outputs& recorded, const Outputs& replayed) {
  const std::string one = BytesOf(recorded);
  const std::string other = BytesOf(replayed);
  if (one == other) return std::nullopt;
  return FirstOf(MessageOf(one), MessageOf(other), "");
}

}  // namespace giveway
