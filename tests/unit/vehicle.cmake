giveway_test(unit vehicle
  SOURCES conflict_test.cc decide_test.cc peer_table_test.cc range_view_test.cc steering_test.cc
          vehicle_rejoin_test.cc vehicle_test.cc
  LINK giveway::vehicle)
