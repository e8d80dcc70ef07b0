# Debian packages by cpack, one a component. ./dev package builds, makes and tries them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME bough)
set(CPACK_PACKAGE_VENDOR "The Bough authors")
set(BOUGH_MAINTAINER "The Bough authors <bough@bough.invalid>" CACHE STRING "Who makes the packages: name and address")
set(CPACK_PACKAGE_CONTACT ${BOUGH_MAINTAINER})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL libbough1 libbough-dev bough-dev)
if(TARGET bough)
  list(APPEND CPACK_COMPONENTS_ALL bough)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
if(TARGET bough_python)
  list(APPEND CPACK_COMPONENTS_ALL python3-bough)
endif()
if(EXISTS ${CMAKE_BINARY_DIR}/html/index.html)
  list(APPEND CPACK_COMPONENTS_ALL bough-doc)
endif()

set(what " From a Nastran deck to finite elements, modes, mass integrals and geometric
 stiffness, and on to the motion of rigid and flexible bodies with contacts,
 sensors, controllers and actuators.\n .\n")
macro(describe component name section brief text)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  string(REPLACE "\n " "\n" plain "${what} ${text}")
  string(REGEX REPLACE "^ " "" plain "${plain}")
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${brief}\n${plain}")   # its first line is the summary
endmacro()
describe(bough bough science "flexible multibody simulation from finite-element models"
  "This package has the program, its manual pages, completions, schemas and\n examples.")
describe(libbough1 libbough1 libs "flexible multibody systems, stepped from C and C++"
  "This package has libbough.so, which needs no PETSc, HDF5 or MPI and is under\n BSD-3-Clause.")
describe(libbough-dev libbough-dev libdevel "flexible multibody systems, stepped from C and C++ (headers)"
  "This package has bough.h, bough.hpp, bough.pc and the CMake package Bough for\n libbough.so.")
describe(bough-dev bough-dev libdevel "flexible multibody simulation from finite-element models (C++)"
  "This package has the static libraries and their headers for the CMake package\n Bough.")
describe(python3-bough python3-bough python "flexible multibody simulation from finite-element models (Python)"
  "This package has the Python module bough.")
describe(bough-doc bough-doc doc "flexible multibody simulation from finite-element models (manual)"
  "This package has the manual as web pages that can be searched.")

# Triggers of the library with a soname:
# who is linked to it depends on its package, and ldconfig runs by a trigger (cpack would
# write scripts in its place, for the modules of other packages too).
file(WRITE ${CMAKE_BINARY_DIR}/packaging-libbough1/shlibs "libbough 1 libbough1 (>= ${PROJECT_VERSION})\n")
file(WRITE ${CMAKE_BINARY_DIR}/packaging-libbough1/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBBOUGH1_PACKAGE_CONTROL_EXTRA
  "${CMAKE_BINARY_DIR}/packaging-libbough1/shlibs;${CMAKE_BINARY_DIR}/packaging-libbough1/triggers")
set(CPACK_DEBIAN_LIBBOUGH1_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_LIBBOUGH-DEV_PACKAGE_DEPENDS "libbough1 (= ${PROJECT_VERSION}-1)")
# Up to 0.2.0 libbough-dev contained the static libraries.
set(CPACK_DEBIAN_BOUGH-DEV_PACKAGE_BREAKS "libbough-dev (<< 0.3.0)")
set(CPACK_DEBIAN_BOUGH-DEV_PACKAGE_REPLACES "libbough-dev (<< 0.3.0)")
set(CPACK_DEBIAN_BOUGH_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_BOUGH_PACKAGE_SUGGESTS "bough-doc, librsvg2-bin, python3-bough")
set(CPACK_DEBIAN_PYTHON3-BOUGH_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON3-BOUGH_PACKAGE_RECOMMENDS "python3-matplotlib")
if(Python3_VERSION_MAJOR)
  math(EXPR next "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON3-BOUGH_PACKAGE_DEPENDS
    "python3 (>= 3.${Python3_VERSION_MINOR}~), python3 (<< 3.${next}), python3-numpy, python3-h5py")
endif()
set(CPACK_DEBIAN_BOUGH-DOC_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_BOUGH-DOC_PACKAGE_DEPENDS libjs-sphinxdoc)   # finish.cmake links to its scripts
# What BoughConfig.cmake looks for and the headers include.
set(CPACK_DEBIAN_BOUGH-DEV_PACKAGE_DEPENDS
  "libbough-dev (= ${PROJECT_VERSION}-1), libeigen3-dev, libsundials-dev, libmuparser-dev, libtomlplusplus-dev, \
nlohmann-json3-dev, libfmt-dev")
if(NOT BOUGH_SOLVER_ONLY)
  string(APPEND CPACK_DEBIAN_BOUGH-DEV_PACKAGE_DEPENDS ", libpetsc-real-dev, libslepc-real-dev, \
libhdf5-openmpi-dev, libopenmpi-dev, libmatio-dev, libzip-dev, libpugixml-dev, libmetis-dev, libmumps-dev, libsuitesparse-dev, \
libblas-dev | libblas.so, liblapack-dev | liblapack.so, pkg-config | pkgconf")
endif()

# Policy: copyright and changelogs of each package, pages compressed. Only for packages, so it goes by cpack's own run.
configure_file(${CMAKE_SOURCE_DIR}/packaging/finish.cmake.in ${CMAKE_BINARY_DIR}/packaging-finish.cmake @ONLY)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_BINARY_DIR}/packaging-finish.cmake)
include(CPack)
