#include "fe/linear/residual.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/diagnostic.hpp"
#include "fe/linear/threads.hpp"

namespace bough::linear {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Residual of one column: y - f over y, and over what the entries of K alone could bring about (residual.hpp).
double calc_residual(const VectorXd& d, const VectorXd& scale, const Eigen::Ref<const VectorXd>& x,
                     const Eigen::Ref<const VectorXd>& y, const Eigen::Ref<const VectorXd>& f) {
  double error = 0, force = 0, entries = 0;  // squares
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    error += (y(i) - f(i)) * (y(i) - f(i)) / scale(i);
    force += y(i) * y(i) / scale(i);
    entries += d(i) * x(i) * x(i);
  }
  return error == 0 ? 0 : std::sqrt(error) / (std::sqrt(force) + 1e-6 * std::sqrt(entries));
}

}  // namespace

VectorXd calc_residuals(const MatrixXd& D, const MatrixXd& X, const MatrixXd& Y, const MatrixXd& F,
                        const RowKinds& kinds) {
  BOUGH_DEMAND(D.rows() == X.rows() && Y.cols() == X.cols() && F.cols() == X.cols());
  VectorXd residual = VectorXd::Zero(X.cols());
  for (Eigen::Index j = 0; j < X.cols(); ++j) {
    const VectorXd d = D.col(D.cols() == 1 ? 0 : j);
    residual(j) = calc_residual(d, fill_diagonal(d, kinds), X.col(j), Y.col(j), F.col(j));
  }
  return residual;
}

VectorXd calc_pair_residuals(const VectorXd& K_diagonal, const VectorXd& M_diagonal, const VectorXd& lambda,
                             const Eigen::Ref<const MatrixXd>& X, const MatrixXd& KX, const MatrixXd& MX,
                             const RowKinds& kinds) {
  VectorXd residual(X.cols());
  do_columns(X.rows(), X.cols(), [&](int from, int to) {
    for (int j = from; j < to; ++j) {
      const VectorXd d = K_diagonal.cwiseAbs() + std::abs(lambda(j)) * M_diagonal.cwiseAbs();
      residual(j) = calc_residual(d, fill_diagonal(d, kinds), X.col(j), KX.col(j), lambda(j) * MX.col(j));
    }
  });
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

}  // namespace bough::linear
