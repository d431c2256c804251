giveway_test(unit link SOURCES channel_model_test.cc impairer_test.cc LINK giveway::link)
