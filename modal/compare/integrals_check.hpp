#pragma once
/// \file Mass integrals of one body side by side (lumped, consistent momentum, exact) and what its modes capture of its
/// mass (docs/theory/flexible-body.md §4).
#include <array>
#include <string>
#include <vector>

#include "formats/records/flex_body.hpp"

namespace bough::modal {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

inline constexpr int kNumIntegrals = 5;
inline constexpr int kNumMethods = 3;
inline constexpr std::array<const char*, kNumMethods> kMethodNames{"lumped", "consistent", "exact"};

/// The set of that index in kMethodNames; may be empty.
const records::MassIntegrals& get_method(const records::FlexBody& body, int method);

/// |Γk| of every mode, n x 5: Frobenius norms; of Γ2 and Γ4 over all modes l of Γ_jl.
MatrixXd calc_integral_norms(const records::MassIntegrals& set);

/// |Γk_j of a - Γk_j of b| / max(|a|, |b|), n x 5; NaN where both vanish, that is lie below 1e-9 of the largest value
/// that Schwarz's inequality allows: |Γ0|² <= m M_jj, |Γ1|² and |Γ3|² <= tr J M_jj, |Γ2|² and |Γ4|² <= M_jj tr M.
MatrixXd calc_integral_differences(const records::MassIntegrals& a, const records::MassIntegrals& b,
                                   const MatrixXd& largest);
/// Largest value of each integral, n x 5.
MatrixXd calc_integral_scale(const records::FlexBody& body);

/// Captured by the first j modes, with their modal mass M: Γ0 M⁻¹ Γ0ᵀ -> m 1, Γ1 M⁻¹ Γ1ᵀ -> J, Γ1 M⁻¹ Γ0ᵀ -> m c̃ on a
/// complete basis of a clamped body, minus the mass at its supports.
struct Captured {
  MatrixXd fraction;  ///< n x 6, cumulative: diagonals of the first two over m, m, m, Jxx, Jyy, Jzz; NaN where J is 0
  Eigen::Matrix<double, 6, 6> total = Eigen::Matrix<double, 6, 6>::Zero();  ///< with all modes, translations first
  Eigen::Matrix<double, 6, 6> rigid = Eigen::Matrix<double, 6, 6>::Zero();  ///< of the body about Bo
};
/// Computes the effective masses from Γ0 and Γ1 of `set`, mode after mode through the Cholesky factor of the modal
/// mass, which may be full.
Captured calc_captured(const records::FlexBody& body, const records::MassIntegrals& set);

struct IntegralsCheck {
  std::array<bool, kNumMethods> has{};
  std::array<MatrixXd, kNumMethods> norm;        ///< n x 5
  std::array<MatrixXd, kNumMethods> difference;  ///< n x 5, from the exact set
  std::array<Captured, kNumMethods> captured;
};
/// The body needs its exact set, else `has` is false for all.
IntegralsCheck check_integrals(const records::FlexBody& body);

}  // namespace bough::modal
