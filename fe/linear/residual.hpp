#pragma once
/// \file Residual of a solution: one measure for modes, load factors and static solutions.
#include <string>
#include <string_view>

#include <Eigen/Dense>

#include "fe/linear/row_kinds.hpp"

namespace bough {
class Diagnostics;
}

namespace bough::linear {

/// Above the first a solution is printed with a warning, above the second it is an error.
inline constexpr double kResidualWarning = 1e-8, kResidualError = 1e-5;

/// Column by column |D⁻¹ᐟ²(Y - F)| / (|D⁻¹ᐟ²Y| + 1e-6 |D¹ᐟ²x|), with Y = K x the forces of strain, F what they should
/// balance (λ M x, or the load) and D > 0 the diagonal of K (and of |λ| M). Free of units and of how stiff single parts
/// are. The second term of the denominator is what the entries of K alone could bring about: where Y is a difference
/// of forces a million times larger, rounding them to sixteen digits leaves less than that of it
/// (docs/theory/modes.md). `kinds`: of the rows, for those that nothing stiffens (fill_diagonal).
Eigen::VectorXd calc_residuals(const Eigen::MatrixXd& D, const Eigen::MatrixXd& X, const Eigen::MatrixXd& Y,
                               const Eigen::MatrixXd& F, const RowKinds& kinds = {});

/// Residuals of static solutions, K X = F with Y = K X: the above, or the work of the residual force over that of the
/// load (Nastran's epsilon) where that is larger: a motion that nothing holds hides in the former behind its own size.
Eigen::VectorXd calc_static_residuals(const Eigen::VectorXd& K_diagonal, const Eigen::MatrixXd& X,
                                      const Eigen::MatrixXd& Y, const Eigen::MatrixXd& F, const RowKinds& kinds = {});

/// Residuals of eigenpairs, with F = M X Λ: D = |K_ii| + |λ_j| |M_ii|.
Eigen::VectorXd calc_pair_residuals(const Eigen::VectorXd& K_diagonal, const Eigen::VectorXd& M_diagonal,
                                    const Eigen::VectorXd& lambda, const Eigen::Ref<const Eigen::MatrixXd>& X,
                                    const Eigen::MatrixXd& KX, const Eigen::MatrixXd& MX, const RowKinds& kinds);

/// D of eigenpairs: |K_ii| + |λ_j| |B_ii|, n x m.
Eigen::MatrixXd calc_residual_scale(const Eigen::VectorXd& K_diagonal, const Eigen::VectorXd& B_diagonal,
                                    const Eigen::VectorXd& lambda);

/// Warning "fe.residual" where the largest is above 1e-8; throws ComputationError("fe.residual") above 1e-5 or where it
/// is no number. `name` is "mode", "load factor", "load case".
void check_residuals(const Eigen::VectorXd& residual, std::string_view name, Diagnostics& diagnostics);

}  // namespace bough::linear
