# Puts page.css and the scripts into page.html, and the page into a C++ string.
#   cmake -DFOLDER= -DSCRIPTS= -DOUTPUT= -P embed.cmake
include(${CMAKE_CURRENT_LIST_DIR}/../embed_text.cmake)
file(READ ${FOLDER}/page.html page)
file(READ ${FOLDER}/page.css style)
set(script "")
foreach(name IN LISTS SCRIPTS)
  file(READ ${FOLDER}/${name} part)
  string(APPEND script "${part}")
endforeach()
string(REPLACE "/*page.css*/" "${style}" page "${page}")
string(REPLACE "/*scripts*/" "${script}" page "${page}")
giveway_embed_text("${page}" services/observer/page/page_text.h PageText ${OUTPUT})
