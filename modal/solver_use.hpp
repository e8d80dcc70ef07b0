#pragma once
/// \file Eigensolver of SLEPc that computed a solution.
#include <string>
#include <vector>

namespace bough::modal {

/// Solutions by one EPS type, read back from the EPS that solved.
struct SolverUse {
  std::string eps;     ///< EPS type of SLEPc, "krylovschur"; those of Bough begin with "bough-"
  std::string st;      ///< type of its spectral transformation
  std::string factor;  ///< of the matrix that the transformation inverts
  int num_solves = 0;  ///< calls of EPSSolve
};

/// Adds the solutions of `use` to those by the same solver.
void add_use(const SolverUse& use, std::vector<SolverUse>& uses);

/// "SLEPc krylovschur, ST bough-factor, LLᵀ CHOLMOD, 2 solves", a line for each solver.
std::string describe_uses(const std::vector<SolverUse>& uses);

/// The EPS type that `name` means ("block-lanczos" is "bough-block-lanczos"). Throws InputError "modal.unknown-solver"
/// where SLEPc has none of this name.
std::string find_eps_type(const std::string& name);

}  // namespace bough::modal
