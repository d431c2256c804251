#include "services/fleetctl/process/run_key.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "services/auth/admin_key.h"
#include "services/fleetctl/process/domain_lock.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

fs::path KeyFolder() {
  const char* const runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime != nullptr && *runtime != '\0' && ::access(runtime, W_OK) == 0) {
    return fs::path(runtime) / "giveway";
  }
  return fs::path(P_tmpdir) / ("giveway-" + std::to_string(::getuid()));
}

// Of this user alone; another may have made one of this name.
bool IsPrivate(const fs::path& folder) {
  struct stat about {};
  return ::lstat(folder.c_str(), &about) == 0 && S_ISDIR(about.st_mode) &&
         about.st_uid == ::getuid() && (about.st_mode & 077U) == 0;
}

std::string KeyFileOf(std::uint32_t domain) {
  return KeyFolder() / ("domain-" + std::to_string(domain) + ".key");
}

}  // namespace

RunKey::RunKey(const std::string& given, std::uint32_t domain) : file_(given) {
  if (!given.empty()) {
    auth::ReadAdminKey(given);  // now, and not in each process
    return;
  }
  const fs::path folder = KeyFolder();
  ::mkdir(folder.c_str(), 0700);
  if (!IsPrivate(folder)) {
    throw auth::KeyError(folder.string() +
                         ": must be a folder of this user that nobody else may enter, for the key "
                         "of the fleet; remove it, or give --admin-key");
  }
  file_ = KeyFileOf(domain);
  auth::MakeAdminKey(file_);
  is_own_ = true;
}

RunKey::~RunKey() {
  if (is_own_) ::unlink(file_.c_str());
}

std::string KeyToOrderWith(const std::string& given, std::uint32_t domain) {
  if (!given.empty()) return auth::ReadAdminKey(given);
  const std::string file = KeyFileOf(domain);
  // One whose fleet is gone was left by a fleetctl that was killed.
  if (!IsTaken(domain) || !IsPrivate(KeyFolder()) || ::access(file.c_str(), R_OK) != 0) return {};
  return auth::ReadAdminKey(file);
}

}  // namespace giveway::fleetctl
