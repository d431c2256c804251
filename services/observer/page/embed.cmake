# Puts page.css and the scripts into page.html, and the page into a C++ string.
#   cmake -DFOLDER= -DSCRIPTS= -DOUTPUT= -P embed.cmake
file(READ ${FOLDER}/page.html page)
file(READ ${FOLDER}/page.css style)
set(script "")
foreach(name IN LISTS SCRIPTS)
  file(READ ${FOLDER}/${name} part)
  string(APPEND script "${part}")
endforeach()
string(REPLACE "/*page.css*/" "${style}" page "${page}")
string(REPLACE "/*scripts*/" "${script}" page "${page}")
# A literal may have at most 65536 characters by the standard; pieces are joined by the compiler.
set(text "")
string(LENGTH "${page}" length)
set(from 0)
while(from LESS length)
  string(SUBSTRING "${page}" ${from} 8000 piece)
  string(APPEND text "R\"page(${piece})page\"\n")
  math(EXPR from "${from} + 8000")
endwhile()
file(WRITE ${OUTPUT} "#include \"services/observer/page/page_text.h\"\n\nnamespace giveway {\n\n"
  "std::string PageText() {\n  return std::string(\n${text}  );\n}\n\n}  // namespace giveway\n")
