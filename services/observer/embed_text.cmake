# Writes a C++ file with a function that gives a text: for files that a program has inside.
function(giveway_embed_text text header function output)
  # A literal may have at most 65536 characters by the standard; pieces are joined by the compiler.
  set(literal "")
  string(LENGTH "${text}" length)
  set(from 0)
  while(from LESS length)
    string(SUBSTRING "${text}" ${from} 8000 piece)
    string(APPEND literal "R\"embedded(${piece})embedded\"\n")
    math(EXPR from "${from} + 8000")
  endwhile()
  file(WRITE ${output} "#include \"${header}\"\n\nnamespace giveway {\n\n"
       "std::string ${function}() {\n  return std::string(\n${literal}  );\n}\n\n}  // namespace giveway\n")
endfunction()
