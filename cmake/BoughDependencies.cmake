# Every outside library in one place, so that the install rules and the package config name the same ones.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Threads REQUIRED)
find_library(MUPARSER_LIBRARY muparser REQUIRED)
find_package(nlohmann_json 3 REQUIRED)
find_package(fmt REQUIRED)
find_package(tomlplusplus REQUIRED)

# Debian's SUNDIALS config drags in targets of optional packages; the few libraries needed are found by name.
find_path(SUNDIALS_INCLUDE_DIR cvode/cvode.h REQUIRED)
foreach(lib cvode nvecserial)
  find_library(SUNDIALS_${lib}_LIBRARY sundials_${lib} REQUIRED)
endforeach()
find_library(SUNDIALS_core_LIBRARY sundials_core)   # from version 7 on
if(NOT SUNDIALS_core_LIBRARY)
  set(SUNDIALS_core_LIBRARY "")
endif()
add_library(bough_sundials INTERFACE)
target_include_directories(bough_sundials SYSTEM INTERFACE $<BUILD_INTERFACE:${SUNDIALS_INCLUDE_DIR}>)
target_link_libraries(bough_sundials INTERFACE
  ${SUNDIALS_cvode_LIBRARY} ${SUNDIALS_nvecserial_LIBRARY}
  ${SUNDIALS_core_LIBRARY})
# Its headers include mpi.h, and its libraries use MPI, from version 7 on where it was built with it, as in Debian 13.
set(SUNDIALS_WITH_MPI OFF)
if(SUNDIALS_core_LIBRARY)
  file(STRINGS ${SUNDIALS_INCLUDE_DIR}/sundials/sundials_config.h with_mpi REGEX "define SUNDIALS_MPI_ENABLED 1")
  if(with_mpi)
    set(SUNDIALS_WITH_MPI ON)
  endif()
endif()
if(SUNDIALS_WITH_MPI)
  find_package(PkgConfig REQUIRED)
  pkg_search_module(MPI REQUIRED IMPORTED_TARGET GLOBAL ompi-c mpich mpi)
  target_link_libraries(bough_sundials INTERFACE PkgConfig::MPI)
endif()

if(NOT BOUGH_SOLVER_ONLY)
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(PETSC REQUIRED IMPORTED_TARGET GLOBAL PETSc)
  pkg_check_modules(SLEPC REQUIRED IMPORTED_TARGET GLOBAL SLEPc)
  # The openmpi flavour is the one PETSc links; the serial one in the same process would clash with it.
  # Debian's names come first. PETSc.pc names MPI for static links only.
  pkg_search_module(MPI REQUIRED IMPORTED_TARGET GLOBAL ompi-c mpich mpi)
  pkg_search_module(HDF5 REQUIRED IMPORTED_TARGET GLOBAL hdf5-openmpi hdf5-mpi hdf5)
  # By name, not by its .pc: that links the serial HDF5, which the openmpi flavour's symbols could then bind to. The
  # library's own use of it stays apart, since Debian gives the symbols of the two flavours different versions.
  find_path(MATIO_INCLUDE_DIR matio.h REQUIRED)
  find_library(MATIO_LIBRARY matio REQUIRED)
  find_library(BLAS_LIBRARY blas REQUIRED)  # the one PETSc uses
  find_library(LAPACK_LIBRARY lapack REQUIRED)
  find_path(METIS_INCLUDE_DIR metis.h REQUIRED)
  find_library(METIS_LIBRARY metis REQUIRED)
  find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)  # the one PETSc uses
  find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
  find_path(ZMUMPS_INCLUDE_DIR zmumps_c.h REQUIRED)  # complex arithmetic; PETSc uses the real one
  find_library(ZMUMPS_LIBRARY zmumps REQUIRED)
  find_package(CLI11 REQUIRED)
  find_path(LIBZIP_INCLUDE_DIR zip.h REQUIRED)
  find_library(LIBZIP_LIBRARY zip REQUIRED)
  find_path(PUGIXML_INCLUDE_DIR pugixml.hpp REQUIRED)
  find_library(PUGIXML_LIBRARY pugixml REQUIRED)
  # Compiled in two parts by Debian, whose .pc has the macros that its classes depend on; header alone elsewhere.
  pkg_check_modules(HTTPLIB IMPORTED_TARGET GLOBAL cpp-httplib)
  if(NOT HTTPLIB_FOUND)
    find_path(HTTPLIB_INCLUDE_DIR httplib.h REQUIRED)
    add_library(bough_httplib INTERFACE)
    target_include_directories(bough_httplib SYSTEM INTERFACE ${HTTPLIB_INCLUDE_DIR})
    target_link_libraries(bough_httplib INTERFACE Threads::Threads)
    add_library(PkgConfig::HTTPLIB ALIAS bough_httplib)
  endif()
endif()
