# BOUGH_PCH: Eigen, the standard library and GoogleTest parsed once and not once a file; half the time of a first build.
# Off by default, so that a plain build shows a missing include; ./dev turns it on. The macro is the one that MPI's
# flags bring to some of the targets: a precompiled header serves only targets whose macros are the same.
option(BOUGH_PCH "Precompiled headers" OFF)
if(BOUGH_PCH)
  target_compile_options(bough_flags INTERFACE $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>>)  # ccache
  target_compile_options(bough_flags INTERFACE
    "$<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:Clang>:SHELL:-Xclang -fno-pch-timestamp>>")  # ccache
  target_compile_definitions(bough_flags INTERFACE $<BUILD_INTERFACE:$<$<CONFIG:Release>:_FORTIFY_SOURCE=2>>)
endif()
set(BOUGH_PCH_COMMON <Eigen/Dense> <algorithm> <array> <charconv> <cmath> <filesystem> <fstream> <functional> <limits>
  <map> <memory> <numbers> <numeric> <optional> <random> <set> <sstream> <string> <string_view> <unordered_map>
  <utility> <vector> "$<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/base/decompositions.hpp>")

# bough_precompile(TARGET OWNER HEADERS header... [LINK target...] [OPTIONS flag...]): the precompiled headers of OWNER,
# made at its first use.
function(bough_precompile target owner)
  cmake_parse_arguments(ARG "" "" "HEADERS;LINK;OPTIONS" ${ARGN})
  if(NOT BOUGH_PCH)
    return()
  endif()
  if(NOT TARGET ${owner})
    set(source ${CMAKE_BINARY_DIR}/generated/${owner}.cpp)
    file(GENERATE OUTPUT ${source} CONTENT "int main() { return 0; }\n")
    get_target_property(type ${target} TYPE)
    if(type STREQUAL EXECUTABLE)
      add_executable(${owner} EXCLUDE_FROM_ALL ${source})
    else()
      add_library(${owner} STATIC EXCLUDE_FROM_ALL ${source})
    endif()
    target_link_libraries(${owner} PRIVATE bough_flags Eigen3::Eigen ${ARG_LINK})
    target_include_directories(${owner} PRIVATE ${CMAKE_SOURCE_DIR})
    target_compile_options(${owner} PRIVATE ${ARG_OPTIONS})
    target_precompile_headers(${owner} PRIVATE ${BOUGH_PCH_COMMON} ${ARG_HEADERS})
  endif()
  target_precompile_headers(${target} REUSE_FROM ${owner})
endfunction()
