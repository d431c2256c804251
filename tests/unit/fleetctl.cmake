giveway_test(unit fleetctl
  SOURCES app_files.cc canary_test.cc doctor_read_test.cc doctor_rules_test.cc shared_memory_test.cc fleet_commands_test.cc fleet_watch_test.cc invariant_watch_test.cc live_table_test.cc replayer_test.cc
          heard_fleet_test.cc interrupts_test.cc listen_topics_test.cc top_table_test.cc
          stopwatch_figures_test.cc stopwatch_plan_test.cc stopwatch_table_test.cc stopwatch_words_test.cc
          plan_test.cc
          tune_evidence_test.cc tune_front_test.cc tune_plan_test.cc tune_predict_test.cc tune_reading_test.cc
          shipped_patrol_test.cc shipped_right_of_way_test.cc shrink_test.cc virtual_batch_test.cc why_proc_test.cc
          why_report_test.cc why_rules_test.cc
  LINK giveway::fleetctl)
target_compile_definitions(unit_fleetctl PRIVATE GIVEWAY_QOS_SETS="${CMAKE_SOURCE_DIR}/config/qos")
