giveway_test(unit vehicle
  SOURCES beacon_news_test.cc ../../services/beacon_news.cc beacon_check_test.cc deaf_watch_test.cc
          blocked_test.cc box_test.cc caught_test.cc claim_test.cc conflict_test.cc decide_test.cc
          detour_test.cc doubt_test.cc echoes_test.cc imperfect_sonar_test.cc lecture_test.cc
          look_test.cc objects_test.cc odometry_test.cc peer_table_test.cc range_view_test.cc refused_beacon_test.cc
          signals_obeyed_test.cc steering_test.cc trust_test.cc unsure_distances_test.cc
          vehicle_rejoin_test.cc vehicle_test.cc waiting_test.cc
  LINK giveway::vehicle)

# Brains in a world, with what the virtual fleet does not carry yet.
giveway_test(unit vehicle_in_world
  SOURCES lying_peer_test.cc sensing_fleet_test.cc signal_crossing_test.cc
  LINK giveway::sim_world giveway::vehicle giveway::virtual)
