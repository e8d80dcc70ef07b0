# BOUGH_UNITY: neighbouring sources compiled as one, so that the templates of Eigen and the standard library that they
# share are made once. Off by default, so that a plain build shows a missing include; ./dev turns it on.
option(BOUGH_UNITY "Compile neighbouring sources together" OFF)
set(BOUGH_UNITY_LINES 3000 CACHE STRING "Lines of sources compiled together")
if(BOUGH_UNITY)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/cmake/unity_groups.py)
endif()

# bough_unity(TARGET): sorts the sources of TARGET into groups in which no name hides another.
function(bough_unity target)
  if(NOT BOUGH_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "^${CMAKE_SOURCE_DIR}/.*\\.cpp$")
  list(FILTER sources EXCLUDE REGEX "^${CMAKE_BINARY_DIR}/")
  list(JOIN sources "\n" lines)
  set(list ${CMAKE_BINARY_DIR}/generated/unity/${target}.txt)
  file(WRITE ${list} "${lines}\n")
  execute_process(COMMAND ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/cmake/unity_groups.py ${CMAKE_SOURCE_DIR}
    ${BOUGH_UNITY_LINES} INPUT_FILE ${list} OUTPUT_VARIABLE groups COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "[^\n]+" groups "${groups}")
  foreach(line ${groups})
    string(REGEX MATCH "^([^:]+):(.+)$" line "${line}")
    set_source_files_properties(${CMAKE_MATCH_2} PROPERTIES UNITY_GROUP ${CMAKE_MATCH_1})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
