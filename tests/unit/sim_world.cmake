giveway_test(unit sim_world
  SOURCES drive_test.cc expectation_test.cc fault_plan_test.cc judge_test.cc motion_test.cc
          reaction_test.cc roster_test.cc run_test.cc scene_test.cc sonar_test.cc world_test.cc
  LINK giveway::sim_world)

# Apart from the others: it replaces operator new for the whole program.
giveway_test(unit sim_world_allocation
  SOURCES sim_world_allocation_test.cc
  LINK giveway::sim_world)
