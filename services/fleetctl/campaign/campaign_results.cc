#include "services/fleetctl/campaign/campaign_results.h"

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <istream>
#include <string_view>
#include <system_error>
#include <utility>

#include "services/config/text_file.h"
#include "services/fleetctl/campaign/campaign_json.h"
#include "services/runtime/utf8.h"

namespace giveway::fleetctl {
namespace {

constexpr std::size_t kLongestComplaint = 500;
constexpr const char* kResultRemedy = "name files or logs of fleetctl campaign shard";

// Why the file is not opened; empty if it can be. A pipe or a device may never end.
std::string WhyNoResults(const std::string& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) return "does not exist";
  if (status.type() == std::filesystem::file_type::directory) return "is a directory";
  if (error) return error.message();
  return status.type() == std::filesystem::file_type::regular ? "" : "is no regular file";
}

enum class LineKind { kOther, kResult, kTooLong };

// Advances to the start of the next line. `line` gets the text of a result, else is left empty.
LineKind TakeLine(std::istream* text, std::string* line) {
  constexpr int kEnd = std::char_traits<char>::eof();
  line->clear();
  const bool is_result = text->peek() == '{';
  bool too_long = false;
  for (int c = text->get(); c != kEnd && c != '\n'; c = text->get()) {
    if (!is_result || too_long) continue;
    line->push_back(static_cast<char>(c));
    too_long = line->size() > kMaxFileBytes;
  }
  if (too_long) line->clear();
  return too_long ? LineKind::kTooLong : is_result ? LineKind::kResult : LineKind::kOther;
}

}  // namespace

void ReadResults(const std::string& file, std::vector<NamedShard>* shards, ProblemList* problems) {
  const auto complain = [&](const std::string& where, const std::string& complaint) {
    problems->Add({.file = where,
                   .message = Shortened(WellFormed(complaint), kLongestComplaint),
                   .remedy = kResultRemedy});
  };
  if (const std::string why = WhyNoResults(file); !why.empty()) return complain(file, why);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return complain(file, "cannot be read");
  std::size_t results = 0;
  std::string line;
  for (std::size_t number = 1; stream.peek() != std::char_traits<char>::eof(); ++number) {
    const LineKind kind = TakeLine(&stream, &line);
    if (kind == LineKind::kOther) continue;
    const std::string where = results++ == 0 ? file : fmt::format("{}:{}", file, number);
    if (kind == LineKind::kTooLong) {
      complain(where, fmt::format("has a line of more than {} bytes", kMaxFileBytes));
      continue;
    }
    ReadShard read = ShardFromJson(line);
    if (!read.complaint.empty()) {
      complain(where, read.complaint);
    } else if (shards->size() == kMostShards) {
      return complain(where, fmt::format("is one more than {} results", kMostShards));
    } else {
      shards->push_back({where, std::move(read.result)});
    }
  }
  if (stream.bad()) return complain(file, "cannot be read to its end");
  if (results == 0) complain(file, "no line of it is a result");
}

}  // namespace giveway::fleetctl
