// Which shard this process is, from the environment set by the engine that started it. Pure: the
// environment is passed as a function.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace giveway::fleetctl {

// The value of a variable; nullopt if it is unset.
using Environment = std::function<std::optional<std::string>(const char* name)>;

// The shard's number from 0 to of - 1: `given` if there is one, else of JOB_COMPLETION_INDEX
// (Kubernetes), SLURM_ARRAY_TASK_ID or PARALLEL_SEQ - 1 (GNU parallel) the only one that is set.
// Throws InputError.
std::uint32_t ShardIndex(const std::optional<std::uint32_t>& given, std::uint32_t of,
                         const Environment& environment);

}  // namespace giveway::fleetctl
