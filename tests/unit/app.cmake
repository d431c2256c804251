giveway_test(unit app
  SOURCES app_files.cc app_flags_test.cc app_health_test.cc app_impair_test.cc app_log_queue_test.cc app_log_test.cc app_parallel_for_test.cc
          app_perturb_test.cc app_picture_test.cc app_place_rules_test.cc app_place_test.cc
          app_process_test.cc app_recorder_test.cc app_recording_file_test.cc app_recording_test.cc app_refusal_log_test.cc app_report_test.cc app_restart_test.cc app_route_test.cc app_braking_rules_test.cc app_scenario_rules_test.cc app_scenario_test.cc
          app_scenario_write_test.cc app_start_shape_test.cc app_state_file_test.cc
          app_text_file_test.cc app_virtual_report_test.cc app_way_back_test.cc
  LINK giveway::app giveway::vehicle giveway::virtual)
target_compile_definitions(unit_app PRIVATE GIVEWAY_VERSION="${PROJECT_VERSION}")
