#pragma once
/// \file What PETSc says of an error.
#include <string>

#include <petscsys.h>

namespace bough::fe {

/// The library's own text of the last error with this code, on one line.
std::string get_petsc_message(PetscErrorCode code);

}  // namespace bough::fe
