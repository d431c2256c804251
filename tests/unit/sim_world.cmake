find_package(rapidcheck REQUIRED)

giveway_test(unit sim_world
  SOURCES admission_places_test.cc admission_test.cc camera_test.cc comings_test.cc drive_test.cc expectation_test.cc fault_plan_test.cc grid_test.cc
          judge_test.cc motion_test.cc neighbours_test.cc obstacles_test.cc outline_motion_test.cc
          reaction_test.cc roster_test.cc run_checkpoint_test.cc run_test.cc scene_test.cc
          sensors_test.cc separation_test.cc signals_test.cc sonar_crosstalk_test.cc
          sonar_kernel_test.cc sonar_oracle_test.cc sonar_property_test.cc sonar_test.cc sonar_tiers_test.cc
          sonar_typical_test.cc world_bodies_test.cc world_fleet_test.cc world_test.cc
  LINK giveway::sim_world rapidcheck)

# Apart from the others: it replaces operator new for the whole program.
giveway_test(unit sim_world_allocation
  SOURCES sim_world_allocation_test.cc
  LINK giveway::sim_world)
