giveway_test(unit vehicle
  SOURCES claim_test.cc conflict_test.cc decide_test.cc detour_test.cc odometry_test.cc
          peer_table_test.cc range_view_test.cc steering_test.cc
          vehicle_test.cc
  LINK giveway::vehicle)
