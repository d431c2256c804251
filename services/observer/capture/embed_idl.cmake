#   cmake -DIDL= -DOUTPUT= -P embed_idl.cmake
include(${CMAKE_CURRENT_LIST_DIR}/../embed_text.cmake)
file(READ ${IDL} idl)
giveway_embed_text("${idl}" services/observer/capture/fleet_capture.h FleetIdl ${OUTPUT})
