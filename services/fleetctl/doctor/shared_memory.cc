#include "services/fleetctl/doctor/shared_memory.h"

#include <sys/stat.h>

#include <algorithm>
#include <map>

namespace giveway::fleetctl {
namespace {

constexpr std::string_view kSemaphore = "sem.";
constexpr std::string_view kMutexEnd = "_mutex";
constexpr std::string_view kLockEnds[] = {"_el", "_sl"};

bool IsOfFastDds(std::string_view body) {
  return body.starts_with("fastrtps_") || body.starts_with("fastdds_") ||
         body.starts_with("fast_datasharing_");
}

bool IsUsed(const MemoryFile& file) {
  return file.held.value_or(file.locked) || !file.users.empty();
}

MemoryState StateOf(const MemoryGroup& group, const std::vector<UnseenProcess>& unseen) {
  const auto any = [&](auto&& is) { return std::ranges::any_of(group.files, is); };
  if (any(IsUsed)) return MemoryState::kInUse;
  const bool hidden = any([&](const MemoryFile& file) {
    return !file.held && std::ranges::any_of(unseen, [&](const UnseenProcess& process) {
      return MayUse(process.user, file);
    });
  });
  if (hidden) return MemoryState::kNotKnown;
  const auto has = [&](MemoryPart part) {
    return any([part](const MemoryFile& file) { return PartOf(file.name) == part; });
  };
  const bool whole = has(MemoryPart::kBody) && has(MemoryPart::kLock);
  return whole ? MemoryState::kStale : MemoryState::kOrphaned;
}

}  // namespace

std::string BodyOf(std::string_view name) {
  if (name.starts_with(kSemaphore) && name.ends_with(kMutexEnd)) {
    name.remove_prefix(kSemaphore.size());
    name.remove_suffix(kMutexEnd.size());
  } else {
    for (const std::string_view end : kLockEnds) {
      if (!name.ends_with(end)) continue;
      name.remove_suffix(end.size());
      break;
    }
  }
  return IsOfFastDds(name) ? std::string(name) : "";
}

MemoryPart PartOf(std::string_view name) {
  if (name.starts_with(kSemaphore)) return MemoryPart::kMutex;
  const bool lock = std::ranges::any_of(
      kLockEnds, [&](const std::string_view end) { return name.ends_with(end); });
  return lock ? MemoryPart::kLock : MemoryPart::kBody;
}

std::uint64_t MemoryGroup::Bytes() const {
  std::uint64_t bytes = 0;
  for (const MemoryFile& file : files) bytes += file.bytes;
  return bytes;
}

std::vector<MemoryGroup> GroupsOf(const SharedMemory& memory) {
  std::map<std::string, MemoryGroup> by_body;
  for (const MemoryFile& file : memory.files) {
    MemoryGroup& group = by_body[BodyOf(file.name)];
    group.body = BodyOf(file.name);
    group.files.push_back(file);
  }
  std::vector<MemoryGroup> groups;
  for (auto& [body, group] : by_body) {
    group.state = StateOf(group, memory.unseen);
    groups.push_back(std::move(group));
  }
  return groups;
}

bool MayUse(std::uint32_t user, const MemoryFile& file) {
  // Group membership is not known here: any process that may be in the file's group counts.
  return user == 0 || user == file.user || (file.mode & (S_IWGRP | S_IWOTH)) != 0;
}

}  // namespace giveway::fleetctl
