# Runs fastddsgen and believes nothing: it exits 0 after some failures, and without a working Java
# it exits 1 and says nothing.
#   cmake -DGENERATOR= -DOPTIONS= -DIDL= -DFOLDER= -DEXPECTED= -P generate.cmake
file(REMOVE ${EXPECTED})
# What it leaves of the preprocessor has one name for all users of the host and for all builds that run
# at once: in /tmp the file of the first user stops every other one.
set(temporary ${FOLDER}/temporary)
file(MAKE_DIRECTORY ${FOLDER} ${temporary})
execute_process(
  COMMAND ${GENERATOR} -cs -replace ${OPTIONS} -t ${temporary} -d ${FOLDER} ${IDL}
  RESULT_VARIABLE result
  OUTPUT_VARIABLE said
  ERROR_VARIABLE said)
file(REMOVE_RECURSE ${temporary})

set(missing "")
foreach(file IN LISTS EXPECTED)
  if(NOT EXISTS ${file})
    list(APPEND missing ${file})
  endif()
endforeach()
if(result STREQUAL "0" AND missing STREQUAL "")
  return()
endif()

execute_process(COMMAND java -version RESULT_VARIABLE java_result OUTPUT_QUIET ERROR_QUIET)
set(hint "")
if(NOT java_result STREQUAL "0")
  set(hint "\n`java -version` fails too (${java_result}): fastddsgen needs a working Java.")
endif()
message(FATAL_ERROR "${GENERATOR} failed on ${IDL}: exit ${result}, missing: [${missing}]${hint}\n"
                    "It said:\n${said}")
