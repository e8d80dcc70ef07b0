#include "fe/linear/residual.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/diagnostic.hpp"

namespace bough::fe {

using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd calc_residuals(const MatrixXd& D, const MatrixXd& X, const MatrixXd& Y, const MatrixXd& F,
                        const RowKinds& kinds) {
  BOUGH_DEMAND(D.rows() == X.rows() && Y.cols() == X.cols() && F.cols() == X.cols());
  VectorXd residual = VectorXd::Zero(X.cols());
  for (Eigen::Index j = 0; j < X.cols(); ++j) {
    const auto d = D.col(D.cols() == 1 ? 0 : j);
    const VectorXd scale = fill_diagonal(d, kinds);
    double wrong = 0, force = 0, entries = 0;
    for (Eigen::Index i = 0; i < d.size(); ++i) {
      wrong += (Y(i, j) - F(i, j)) * (Y(i, j) - F(i, j)) / scale(i);
      force += Y(i, j) * Y(i, j) / scale(i);
      entries += d(i) * X(i, j) * X(i, j);
    }
    const double size = std::sqrt(force) + 1e-6 * std::sqrt(entries);
    residual(j) = wrong == 0 ? 0 : std::sqrt(wrong) / size;
  }
  return residual;
}

VectorXd calc_static_residuals(const VectorXd& K_diagonal, const MatrixXd& X, const MatrixXd& Y, const MatrixXd& F,
                               const RowKinds& kinds) {
  VectorXd residual = calc_residuals(K_diagonal.cwiseAbs(), X, Y, F, kinds);
  for (Eigen::Index j = 0; j < X.cols(); ++j) {
    const double work = std::abs(X.col(j).dot(F.col(j)));
    if (work > 0) residual(j) = std::max(residual(j), std::abs(X.col(j).dot(Y.col(j) - F.col(j))) / work);
  }
  return residual;
}

MatrixXd calc_residual_scale(const VectorXd& K_diagonal, const VectorXd& B_diagonal, const VectorXd& lambda) {
  return K_diagonal.cwiseAbs().replicate(1, lambda.size()) + B_diagonal.cwiseAbs() * lambda.cwiseAbs().transpose();
}

void check_residuals(const VectorXd& residual, std::string_view name, Diagnostics& diagnostics) {
  Eigen::Index worst = 0;
  for (Eigen::Index j = 0; j < residual.size(); ++j)
    if (std::isnan(residual(j)) || residual(j) > residual(worst)) worst = j;
  if (residual.size() == 0 || residual(worst) <= kResidualWarning) return;
  char number[32];
  std::snprintf(number, sizeof number, "%.1e", residual(worst));
  const std::string what =
      "the residual of " + std::string(name) + " " + std::to_string(worst + 1) + " is " + number + ", expected below ";
  const std::string advice =
      "look for very soft and very stiff parts side by side (replace the stiffest by rigid elements), and for parts "
      "that nothing holds";
  if (!(residual(worst) <= kResidualError)) throw ComputationError("fe.residual", {}, what + "1e-05", advice);
  diagnostics.warning("fe.residual", {}, what + "1e-08", advice);
}

}  // namespace bough::fe
