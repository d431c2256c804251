giveway_test(unit virtual
  SOURCES crossing_test.cc encounters_test.cc lecture_flaws_test.cc
  LINK giveway::virtual)
