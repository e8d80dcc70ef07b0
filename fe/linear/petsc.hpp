#pragma once
/// \file Owning handles for PETSc objects, initialization on demand, and error translation.
#include <petscksp.h>

#include <string>
#include <utility>

#include <Eigen/Dense>

namespace bough::linear {

/// PETSc's own text of the last error with this code, on one line.
std::string get_petsc_message(PetscErrorCode code);
/// Throws ComputationError("fe.petsc") with PETSc's text when code is not zero.
void check_petsc(PetscErrorCode code);

/// Initializes MPI and PETSc once per process; finalized at exit. Verbs that need no FE never call it.
/// Returns the rank and size of PETSC_COMM_WORLD.
struct MpiWorld {
  int rank = 0, size = 1;
};
/// Initializes MPI and PETSc in the first call and returns rank and size; signal handlers stay those of the process.
MpiWorld initialize_petsc();

/// Sets how deep parallel regions of OpenMP may be nested from this thread on: 0 is one thread. Returns what it was
/// before;
/// nothing happens where no library of the process uses OpenMP.
int set_openmp_levels(int levels);

/// Owning handle; Destroy is PETSc's MatDestroy and so on.
template <class T, PetscErrorCode (*Destroy)(T*)>
class PetscHandle {
 public:
  PetscHandle() = default;
  explicit PetscHandle(T object) : object_(object) {}
  PetscHandle(PetscHandle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  /// Exchanges the objects; the destructor of `other` destroys the former one.
  PetscHandle& operator=(PetscHandle&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  ~PetscHandle() {
    if (object_) Destroy(&object_);
  }
  /// The object, still owned by this.
  T get() const { return object_; }
  /// Address for PETSc's functions that create an object; the former object is not destroyed.
  T* out() { return &object_; }
  /// Returns true if there is an object.
  explicit operator bool() const { return object_ != nullptr; }

 private:
  T object_ = nullptr;
};
using PetscMat = PetscHandle<Mat, MatDestroy>;
using PetscVec = PetscHandle<Vec, VecDestroy>;
using PetscKsp = PetscHandle<KSP, KSPDestroy>;

}  // namespace bough::linear
