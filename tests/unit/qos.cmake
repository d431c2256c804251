giveway_test(unit qos
  SOURCES qos_bad_files_test.cc qos_changes_test.cc qos_check_test.cc qos_compose_test.cc qos_order_check_test.cc qos_profile_edit_test.cc qos_profile_set_test.cc qos_request_offered_test.cc qos_rollout_test.cc
  LINK giveway::qos)
target_compile_definitions(
  unit_qos PRIVATE GIVEWAY_QOS_SETS="${CMAKE_SOURCE_DIR}/config/qos"
                   GIVEWAY_BAD_QOS="${CMAKE_CURRENT_SOURCE_DIR}/bad_qos")
