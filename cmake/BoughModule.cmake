# bough_module(NAME SOURCES_DIRS dir... DEPENDS target...): one static library bough::NAME from every .cpp below the
# given folders (default: this one). Headers sit beside their sources; the path in an include is the path in the
# repository, and below include/bough after installation.
add_library(bough_flags INTERFACE)
target_compile_options(bough_flags INTERFACE $<BUILD_INTERFACE:-Wall;-Wextra;-Wpedantic;-Wshadow>
  $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>>
  # A failed demand names its source by the path in the repository: builds in different folders give the same bytes.
  $<BUILD_INTERFACE:-fmacro-prefix-map=${CMAKE_SOURCE_DIR}/=>
  # Names that neighbours of a unity group share; fields that have defaults; the report page in one literal.
  "$<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:Clang>:-Wno-shadow;-Wno-missing-field-initializers;-Wno-overlength-strings>>")
if(BOUGH_SANITIZE)
  # A finding ends the program: a test that only prints one would pass. Eigen makes references to the first entry of
  # empty matrices, and blocks of them; null pointers that are used the address sanitizer finds itself.
  set(checks -fsanitize=${BOUGH_SANITIZE} -fno-sanitize-recover=all -fno-sanitize=null,alignment,vptr,pointer-overflow)
  target_compile_options(bough_flags INTERFACE "$<BUILD_INTERFACE:${checks};-fno-omit-frame-pointer>")
  target_compile_definitions(bough_flags INTERFACE $<BUILD_INTERFACE:_GLIBCXX_ASSERTIONS>)
  target_link_options(bough_flags INTERFACE $<BUILD_INTERFACE:-fsanitize=${BOUGH_SANITIZE}>)
endif()
if(BOUGH_NAN)
  target_compile_definitions(bough_flags INTERFACE $<BUILD_INTERFACE:EIGEN_INITIALIZE_MATRICES_BY_NAN>)
endif()

function(bough_module name)
  cmake_parse_arguments(ARG "" "" "SOURCE_DIRS;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  if(NOT ARG_SOURCE_DIRS)
    set(ARG_SOURCE_DIRS .)
  endif()
  set(sources)
  foreach(dir ${ARG_SOURCE_DIRS})
    file(GLOB_RECURSE found CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${dir}/*.cpp)
    list(APPEND sources ${found})
  endforeach()
  if(sources)
    add_library(bough_${name} STATIC ${sources})
    set(scope PUBLIC)
    target_link_libraries(bough_${name} PRIVATE $<BUILD_INTERFACE:bough_flags> ${ARG_PRIVATE_DEPENDS})
    bough_precompile(bough_${name} bough_pch)
    bough_unity(bough_${name})
  else()
    add_library(bough_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(bough::${name} ALIAS bough_${name})
  target_compile_features(bough_${name} INTERFACE cxx_std_20)  # of the headers, for who links the library
  set_target_properties(bough_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(bough_${name} ${scope}
    $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/bough>)
  target_link_libraries(bough_${name} ${scope} ${ARG_DEPENDS})
  set_property(GLOBAL APPEND PROPERTY BOUGH_MODULES bough_${name})
endfunction()
