#pragma once
/// \file Spectral transformation (ST) of SLEPc by a factor that exists: (A - σB)⁻¹B or B⁻¹A, on vectors and on blocks.
///
/// Internal to modal.
#include <slepcst.h>

#include <exception>
#include <functional>
#include <string>

#include <Eigen/Dense>

#include "fe/linear/factor.hpp"

namespace bough::modal::detail {

/// Product or solution of a block of vectors.
using BlockApply = std::function<Eigen::MatrixXd(const Eigen::Ref<const Eigen::MatrixXd>&)>;

/// The operator of an ST "bough-factor". F is the factored matrix: A - σB near a shift, else B.
struct FactoredOperator {
  BlockApply solve;                                 ///< F⁻¹X
  BlockApply multiply_mass;                         ///< B X, of the inner product
  BlockApply multiply_operator;                     ///< A X where the operator is B⁻¹A; empty: (A - σB)⁻¹B
  const linear::SymmetricFactor* factor = nullptr;  ///< of F
  const Eigen::MatrixXd* deflation = nullptr;       ///< B-orthonormal, projected out of each product; null: none
  std::string factor_name;

  /// Returns true if the operator is (A - σB)⁻¹B, false if it is B⁻¹A.
  bool is_near_shift() const { return !multiply_operator; }
};

inline constexpr const char* kFactorTransform = "bough-factor";

/// Registers the ST type; again is harmless.
void register_factored_transform();

/// Makes `st` a "bough-factor" that applies `op`, which outlives its use.
void set_operator(ST st, const FactoredOperator& op);

/// Operator of an ST of this type; null for any other.
const FactoredOperator* find_operator(ST st);

/// Exception that the operator threw within SLEPc; null: nothing.
std::exception_ptr get_failure(ST st);

/// Runs a function that may throw where C code calls: keeps the exception and returns an error code.
template <class Function>
PetscErrorCode run_guarded(std::exception_ptr& failure, const Function& function) {
  try {
    function();
    return 0;
  } catch (...) {
    failure = std::current_exception();
    return PETSC_ERR_USER;
  }
}

}  // namespace bough::modal::detail
