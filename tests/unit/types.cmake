find_package(rapidcheck REQUIRED)

giveway_test(unit types
  SOURCES discovery_server_test.cc distance_test.cc math_test.cc pose_test.cc profile_test.cc random_test.cc order_test.cc
  LINK giveway::types rapidcheck)
