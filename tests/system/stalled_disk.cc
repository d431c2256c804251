// Preloaded into a process: a disk that stalls. The fifth checkpoint is put in place five seconds
// late.
#include <dlfcn.h>

#include <chrono>
#include <cstdio>
#include <cstring>
#include <thread>

extern "C" int rename(const char* from, const char* to) noexcept {
  static int checkpoints = 0;
  using Rename = int (*)(const char*, const char*);
  static const auto library = reinterpret_cast<Rename>(dlsym(RTLD_NEXT, "rename"));
  if (std::strstr(to, ".checkpoint") != nullptr && ++checkpoints == 5) {
    std::fputs("the disk stalls\n", stderr);
    std::this_thread::sleep_for(std::chrono::seconds(5));
    std::fputs("the disk is back\n", stderr);
  }
  return library(from, to);
}
