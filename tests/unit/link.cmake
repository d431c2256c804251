giveway_test(unit link SOURCES channel_model_test.cc impairer_test.cc unfit_endpoints_test.cc LINK giveway::link)
