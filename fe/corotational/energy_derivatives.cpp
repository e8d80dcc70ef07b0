#include "fe/corotational/energy_derivatives.hpp"

#include "fe/corotational/corotational_element.hpp"
#include "fe/corotational/series.hpp"

namespace bough::fe {

MatrixXd calc_force_series(const ElementSpan& elements, const std::vector<Node>& nodes,
                           const Eigen::Ref<const MatrixXd>& u) {
  MatrixXd f = MatrixXd::Zero(u.rows(), u.cols());
  for (const auto& element : elements) {
    const auto& gdofs = element->gdofs();
    f(gdofs, Eigen::all) += CorotationalElement(*element, nodes).calc_forces(u(gdofs, Eigen::all));
  }
  return f;
}

namespace {

/// Order `order` of the forces along ε x, for every column x.
MatrixXd calc_order(const ElementSpan& elements, const std::vector<Node>& nodes, const MatrixXd& x, int order) {
  MatrixXd u = MatrixXd::Zero(x.rows(), kSeriesTop * x.cols());
  for (Eigen::Index c = 0; c < x.cols(); ++c) u.col(kSeriesTop * c) = x.col(c);
  const MatrixXd f = calc_force_series(elements, nodes, u);
  MatrixXd result(x.rows(), x.cols());
  for (Eigen::Index c = 0; c < x.cols(); ++c) result.col(c) = f.col(kSeriesTop * c + order - 1);
  return result;
}

}  // namespace

/// Order 2 of the forces along x is ½ V‴(x, x, ·).
MatrixXd calc_third_derivative(const ElementSpan& elements, const std::vector<Node>& nodes,
                               const Eigen::Ref<const MatrixXd>& A, const Eigen::Ref<const MatrixXd>& B) {
  BOUGH_DEMAND(A.rows() == B.rows() && A.cols() == B.cols());
  const Eigen::Index m = A.cols();
  MatrixXd x(A.rows(), 2 * m);
  x << A + B, A - B;
  const MatrixXd f = calc_order(elements, nodes, x, 2);
  return 0.5 * (f.leftCols(m) - f.rightCols(m));
}

/// Order 3 along x is ⅙ V⁗(x, x, x, ·).
MatrixXd calc_fourth_derivative(const ElementSpan& elements, const std::vector<Node>& nodes,
                                const Eigen::Ref<const MatrixXd>& A, const Eigen::Ref<const MatrixXd>& B,
                                const Eigen::Ref<const MatrixXd>& C) {
  BOUGH_DEMAND(A.rows() == B.rows() && A.cols() == B.cols() && A.rows() == C.rows() && A.cols() == C.cols());
  const Eigen::Index m = A.cols();
  MatrixXd x(A.rows(), 4 * m);
  x << A + B + C, A - B - C, A + B - C, A - B + C;
  const MatrixXd f = calc_order(elements, nodes, x, 3);
  return 0.25 * (f.leftCols(m) + f.middleCols(m, m) - f.middleCols(2 * m, m) - f.rightCols(m));
}

}  // namespace bough::fe
