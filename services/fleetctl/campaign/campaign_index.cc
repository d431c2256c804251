#include "services/fleetctl/campaign/campaign_index.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <vector>

#include "services/config/problem.h"

namespace giveway::fleetctl {
namespace {

struct EngineVariable {
  const char* name;
  std::uint32_t first;  // its value for the first shard
};
constexpr std::array<EngineVariable, 3> kEngines = {
    {{"JOB_COMPLETION_INDEX", 0}, {"SLURM_ARRAY_TASK_ID", 0}, {"PARALLEL_SEQ", 1}}};

[[noreturn]] void Refuse(const std::string& field, const std::string& value,
                         const std::string& message, const std::string& remedy) {
  throw InputError({{"campaign shard", 0, field, value, message, remedy}});
}

// The number there, counted from 0.
std::uint32_t NumberIn(const EngineVariable& engine, const std::string& text, std::uint32_t of) {
  std::uint32_t number = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error == std::errc() && rest == end && number >= engine.first && number - engine.first < of) {
    return number - engine.first;
  }
  Refuse(engine.name, text,
         fmt::format("must be a whole number from {} to {} for {} shards", engine.first,
                     of - 1 + engine.first, of),
         "start as many as --of says, or name the shard with --index");
}

}  // namespace

std::uint32_t ShardIndex(const std::optional<std::uint32_t>& given, std::uint32_t of,
                         const Environment& environment) {
  if (given) {
    if (*given < of) return *given;
    Refuse("--index", std::to_string(*given),
           fmt::format("must be from 0 to {} for {} shards", of - 1, of),
           "count from 0, or give --of");
  }
  const EngineVariable* set = nullptr;
  std::string value;
  std::string names;
  int found = 0;
  for (const EngineVariable& engine : kEngines) {
    const auto text = environment(engine.name);
    if (!text) continue;
    ++found;
    names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", engine.name, *text);
    set = &engine;
    value = *text;
  }
  if (found == 1) return NumberIn(*set, value, of);
  if (found > 1) {
    Refuse("--index", "", "is not given, and more than one engine names a shard: " + names,
           "name the shard with --index");
  }
  Refuse("--index", "",
         "is not given, and neither JOB_COMPLETION_INDEX, SLURM_ARRAY_TASK_ID nor PARALLEL_SEQ is "
         "set",
         fmt::format("name the shard with --index 0 to {}", of - 1));
}

}  // namespace giveway::fleetctl
