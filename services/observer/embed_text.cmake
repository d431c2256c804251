# Writes a C++ file with a function that gives a text: for files that a program has inside.
function(giveway_embed_text text header function output)
  # A literal may have at most 65536 characters by the standard, also one that the compiler joins of
  # several.
  set(pieces "")
  string(LENGTH "${text}" length)
  set(from 0)
  while(from LESS length)
    string(SUBSTRING "${text}" ${from} 8000 piece)
    string(APPEND pieces "  text += R\"embedded(${piece})embedded\";\n")
    math(EXPR from "${from} + 8000")
  endwhile()
  file(WRITE ${output} "#include \"${header}\"\n\nnamespace giveway {\n\n"
       "std::string ${function}() {\n  std::string text;\n${pieces}  return text;\n}\n\n}  // namespace giveway\n")
endfunction()
