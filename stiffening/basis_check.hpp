#pragma once
/// \file Check of the modal matrices of a body against its shapes.
#include "base/diagnostic.hpp"
#include "fe/model/model.hpp"
#include "modal/bases/fixed_interface.hpp"

namespace bough::stiffening {

/// Differences of the modal matrices from ΦᵀMΦ and ΦᵀKΦ, both summed over the elements: the largest entry relative to
/// √(M_ii M_jj) and √(K_ii K_jj).
struct BasisCheck {
  double mass = 0, stiffness = 0;
  double beyond_roundoff = 0;  ///< of both; entries of K above kStiffnessRoundoff of √(pᵢ pⱼ), pⱼ = Σ K_ii φ_ij²
  modal::bases::ModesCheck modes;  ///< of the normal modes; none found: none were solved for
};
/// Largest difference without a warning: the round-off of stiffness ratios up to 1e10 is below.
inline constexpr double kBasisWarning = 1e-5;
/// Largest difference that is not an error: above it, frequencies are wrong by 0.05 % and more.
inline constexpr double kBasisError = 1e-3;

/// Compares the modal matrices [n x n] with the sums over elements of Phi [num_gdofs x n]; no modes: no difference.
BasisCheck check_basis(const fe::Model& model, const Eigen::MatrixXd& Phi, const Eigen::MatrixXd& modal_mass,
                       const Eigen::MatrixXd& modal_stiffness);

/// Warning reduce.basis-off above kBasisWarning; ComputationError of this id if one is not finite, or above kBasisError
/// and more than round-off.
void report_basis(const BasisCheck& check, const SourceLocation& at, Diagnostics& diagnostics);

}  // namespace bough::stiffening
