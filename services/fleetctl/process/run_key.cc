#include "services/fleetctl/process/run_key.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <vector>

#include "services/auth/admin_key.h"
#include "services/fleetctl/process/domain_lock.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

// Where keys may be: a run and the operator who gives it orders need not have the same environment.
// sudo and cron drop XDG_RUNTIME_DIR, which is the second place then.
std::vector<fs::path> KeyFolders() {
  const std::string user = std::to_string(::getuid());
  std::vector<fs::path> folders;
  const char* const runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime != nullptr && *runtime != '\0') folders.push_back(fs::path(runtime) / "giveway");
  folders.push_back(fs::path("/run/user") / user / "giveway");
  folders.push_back(fs::path(P_tmpdir) / ("giveway-" + user));
  return folders;
}

// Where a new one is created.
fs::path KeyFolder() {
  for (const fs::path& folder : KeyFolders()) {
    if (::access(folder.parent_path().c_str(), W_OK) == 0) return folder;
  }
  return KeyFolders().back();
}

// Owned by this user and accessible to no other. Another may have made a folder of this name.
bool IsPrivate(const fs::path& folder) {
  struct stat about {};
  return ::lstat(folder.c_str(), &about) == 0 && S_ISDIR(about.st_mode) &&
         about.st_uid == ::getuid() && (about.st_mode & 077U) == 0;
}

std::string KeyFileOf(const fs::path& folder, std::uint32_t domain) {
  return folder / ("domain-" + std::to_string(domain) + ".key");
}

// The newest: older ones were left by a fleetctl that was killed. Empty: none.
std::string FindKeyFile(std::uint32_t domain) {
  std::string newest;
  fs::file_time_type newest_time{};
  for (const fs::path& folder : KeyFolders()) {
    const std::string file = KeyFileOf(folder, domain);
    if (!IsPrivate(folder) || ::access(file.c_str(), R_OK) != 0) continue;
    std::error_code error;
    const fs::file_time_type time = fs::last_write_time(file, error);
    if (error || (!newest.empty() && time <= newest_time)) continue;
    newest = file;
    newest_time = time;
  }
  return newest;
}

}  // namespace

RunKey::RunKey(const std::string& given, std::uint32_t domain) : file_(given) {
  if (!given.empty()) {
    auth::ReadAdminKey(given);  // check it now, once for all processes
    return;
  }
  const fs::path folder = KeyFolder();
  ::mkdir(folder.c_str(), 0700);
  if (!IsPrivate(folder)) {
    throw auth::KeyError(folder.string() +
                         ": must be a folder of this user that no other user may enter, because it "
                         "holds the fleet's key; remove it, or give --admin-key");
  }
  file_ = KeyFileOf(folder, domain);
  auth::MakeAdminKey(file_);
  is_own_ = true;
}

RunKey::~RunKey() {
  if (is_own_) ::unlink(file_.c_str());
}

std::string KeyToOrderWith(const std::string& given, std::uint32_t domain) {
  if (!given.empty()) return auth::ReadAdminKey(given);
  if (!IsTaken(domain)) return {};
  const std::string file = FindKeyFile(domain);
  return file.empty() ? std::string() : auth::ReadAdminKey(file);
}

}  // namespace giveway::fleetctl
