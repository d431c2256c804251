giveway_test(unit virtual
  SOURCES crossing_test.cc distance_gates_test.cc encounters_test.cc lecture_flaws_test.cc generators_test.cc
          invariants_test.cc progress_test.cc radio_test.cc red_lights_test.cc virtual_fleet_test.cc
  LINK giveway::virtual)

# The baselines our delay is measured against (tests/bench).
giveway_test(unit baseline
  SOURCES baseline_half_planes_test.cc baseline_pilots_test.cc baseline_tiles_test.cc
          baseline_way_test.cc
  LINK giveway_baselines)
