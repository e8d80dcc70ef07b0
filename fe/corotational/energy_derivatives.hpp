#pragma once
/// \file Internal forces of all elements along curves, and the third and fourth derivatives of the strain energy V.
///
/// Derivatives are at the undeformed state, in the g-set (translations and rotation vectors in basic), columns for
/// several tuples of directions at once. Rigid links and constraints are the caller's.
#include <memory>
#include <vector>

#include "fe/elements/element.hpp"

namespace bough::fe {

using ElementSpan = std::vector<std::unique_ptr<const Element>>;

/// Coefficients 1 to 5 of ∂V/∂u along m curves u(ε) = Σ ε^k u_k. u, result: num_gdofs x 5 m, the orders of a curve side
/// by side. One pass over the elements.
MatrixXd calc_force_series(const ElementSpan& elements, const std::vector<Node>& nodes,
                           const Eigen::Ref<const MatrixXd>& u);

/// V‴(a_c, b_c, ·) for every column c: num_gdofs x m.
MatrixXd calc_third_derivative(const ElementSpan& elements, const std::vector<Node>& nodes,
                               const Eigen::Ref<const MatrixXd>& A, const Eigen::Ref<const MatrixXd>& B);

/// V⁗(a_c, b_c, c_c, ·).
MatrixXd calc_fourth_derivative(const ElementSpan& elements, const std::vector<Node>& nodes,
                                const Eigen::Ref<const MatrixXd>& A, const Eigen::Ref<const MatrixXd>& B,
                                const Eigen::Ref<const MatrixXd>& C);

}  // namespace bough::fe
