#include "modal/compare/test_model.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "fe/matrices/assembly.hpp"

namespace bough::modal {

using Eigen::Index;

namespace {

/// XᵀAX without the rounding that makes it unsymmetric.
MatrixXd calc_gram(const MatrixXd& X, const MatrixXd& AX) {
  const MatrixXd product = X.transpose() * AX;
  return 0.5 * (product + product.transpose());
}

}  // namespace

TestModel calc_test_model(const fe::Model& model, bool is_improved) {
  TestModel reduced;
  for (int f = 0; f < model.num_fdofs(); ++f) reduced.dofs.push_back(model.describe_fdof(f));
  MatrixXd T = MatrixXd(model.T());
  MatrixXd MT = fe::calc_mass_times(model, model.mass_kind(), T);
  reduced.M = calc_gram(T, MT);
  reduced.K = calc_gram(T, fe::calc_stiffness_times(model, T));
  const Eigen::LLT<MatrixXd> factor(reduced.M);
  if (factor.info() != Eigen::Success)
    throw ComputationError("modal.test-mass", {}, "the mass matrix of the test-analysis model is singular",
                           "leave measured dofs without mass out of the test");
  if (is_improved && model.omitted()) {
    T += model.omitted()(MT * factor.solve(reduced.K));
    MT = fe::calc_mass_times(model, model.mass_kind(), T);
    reduced.M = calc_gram(T, MT);
    reduced.K = calc_gram(T, fe::calc_stiffness_times(model, T));
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(reduced.K, reduced.M, Eigen::EigenvaluesOnly);
  reduced.frequency_hz = solver.eigenvalues().cwiseMax(0).cwiseSqrt() / (2 * std::numbers::pi);
  return reduced;
}

}  // namespace bough::modal
