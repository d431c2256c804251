// A process at its limit of descriptors: no file or socket can be opened while it lives. Those that
// are open stay so.
#pragma once

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "services/types/sanitizers.h"

namespace giveway::test {

class NoDescriptors {
 public:
  // With the address sanitizer goes the undefined behaviour sanitizer, which looks at the class of
  // an object through a pipe: without descriptors it takes a thrown error for no object, and
  // aborts.
#ifdef GIVEWAY_ADDRESS_SANITIZER
  static constexpr bool kErrorsCanBeThrown = false;
#else
  static constexpr bool kErrorsCanBeThrown = true;
#endif

  NoDescriptors() {
    EXPECT_EQ(getrlimit(RLIMIT_NOFILE, &before_), 0);
    const rlimit none{0, before_.rlim_max};
    EXPECT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  }
  ~NoDescriptors() { setrlimit(RLIMIT_NOFILE, &before_); }
  NoDescriptors(const NoDescriptors&) = delete;
  NoDescriptors& operator=(const NoDescriptors&) = delete;

 private:
  rlimit before_{};
};

}  // namespace giveway::test
