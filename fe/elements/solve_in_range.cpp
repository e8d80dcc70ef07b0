#include "fe/elements/solve_in_range.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

namespace bough::fe {

Eigen::MatrixXd solve_in_range(const Eigen::MatrixXd& K, const Eigen::MatrixXd& B) {
  constexpr double kRangeTolerance = 1e-13;  // of eigenvalues of K scaled by its diagonal
  Eigen::VectorXd scale = K.diagonal();
  for (double& value : scale) value = value > 0 ? 1 / std::sqrt(value) : 0;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * K * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  Eigen::VectorXd inverse = eigen.eigenvalues();
  const double limit = kRangeTolerance * static_cast<double>(K.rows()) * inverse.maxCoeff();
  for (double& value : inverse) value = value > limit ? 1 / value : 0;
  const Eigen::MatrixXd V = scale.asDiagonal() * eigen.eigenvectors();
  return V * (inverse.asDiagonal() * (V.transpose() * B));
}

}  // namespace bough::fe
