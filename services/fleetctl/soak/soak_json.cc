#include "services/fleetctl/soak/soak_json.h"

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include <cmath>
#include <filesystem>

#include "services/config/problem.h"
#include "services/config/text_file.h"
#include "services/fleetctl/soak/soak_schema.h"
#include "services/types/check.h"

namespace giveway::fleetctl {

std::string ToJson(const SoakResult& result) {
  google::protobuf::util::JsonPrintOptions options;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string json;
  const auto status = google::protobuf::util::MessageToJsonString(SchemaOf(result), &json, options);
  GIVEWAY_CHECK(status.ok(), status.ToString());
  return json;
}

ReadSoak SoakFromJson(std::string_view json) {
  schema::SoakReport message;
  const auto status = google::protobuf::util::JsonStringToMessage(std::string(json), &message);
  if (!status.ok()) {
    return {{}, fmt::format("is no report of fleetctl soak: {}", std::string(status.message()))};
  }
  ReadSoak read;
  read.complaint = ReadInto(message, &read.result);
  return read;
}

ReadSoak ReadSoakReport(const std::string& path) {
  std::error_code unreadable;
  const std::filesystem::path named(path);
  const std::string file =
      (std::filesystem::is_directory(named, unreadable) ? named / "report.json" : named).string();
  try {
    ReadSoak read = SoakFromJson(ReadTextFile(file));
    if (!read.complaint.empty()) {
      read.complaint = file + ": " + read.complaint +
                       "; name a report.json that fleetctl soak --report wrote, or its folder";
    }
    return read;
  } catch (const InputError& error) {
    return {{}, error.what()};
  }
}

}  // namespace giveway::fleetctl
