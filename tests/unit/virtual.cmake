giveway_test(unit virtual
  SOURCES crossing_test.cc distance_gates_test.cc encounters_test.cc lecture_flaws_test.cc generators_test.cc
          invariants_test.cc radio_test.cc virtual_fleet_test.cc
  LINK giveway::virtual)
