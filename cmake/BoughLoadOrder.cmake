# The dynamic loader looks for each symbol in one library after the other, in the order in which the program needs them,
# and PETSc's Debian package needs a hundred: two thirds of a start are this search. Those that most symbols come from
# are named first on the link line, so that the search ends sooner (75 ms of processor time become 50 ms). Libraries
# that have names in common keep their order: BLAS before the others that have one, SuperLU before its distributed form,
# PT-Scotch before Scotch.
set(BOUGH_FIRST_LIBRARIES "")
find_program(BOUGH_LDD ldd)
if(BOUGH_LDD AND NOT BOUGH_SANITIZE AND NOT BOUGH_SOLVER_ONLY)
  get_target_property(petsc PkgConfig::PETSC INTERFACE_LINK_LIBRARIES)
  list(GET petsc 0 petsc)
  execute_process(COMMAND ${BOUGH_LDD} ${petsc} OUTPUT_VARIABLE needed ERROR_QUIET)
  foreach(name blas lapack openblas trilinos_teuchosparameterlist crypto trilinos_ml superlu superlu_dist trilinos_ifpack
      trilinos_epetra trilinos_epetraext trilinos_teuchoscomm fftw3 ptscotch-7.0 gnutls nettle trilinos_aztecoo
      trilinos_teuchoscore trilinos_zoltan trilinos_teuchosparser trilinos_amesos)
    string(REPLACE "." "\\." pattern ${name})
    if(needed MATCHES "=> ([^ \n]*/lib${pattern}\\.so[^ \n]*)")
      list(APPEND BOUGH_FIRST_LIBRARIES ${CMAKE_MATCH_1})
    endif()
  endforeach()
endif()
