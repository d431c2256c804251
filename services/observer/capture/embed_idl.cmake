#   cmake -DIDL= -DOUTPUT= -P embed_idl.cmake
file(READ ${IDL} idl)
set(text "")
string(LENGTH "${idl}" length)
set(from 0)
while(from LESS length)
  string(SUBSTRING "${idl}" ${from} 8000 piece)
  string(APPEND text "R\"idl(${piece})idl\"\n")
  math(EXPR from "${from} + 8000")
endwhile()
file(WRITE ${OUTPUT} "#include \"services/observer/capture/fleet_capture.h\"\n\nnamespace giveway {\n\n"
  "std::string FleetIdl() {\n  return std::string(\n${text}  );\n}\n\n}  // namespace giveway\n")
