#include "modal/compare/correlation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "base/diagnostic.hpp"

namespace bough::modal {

using Eigen::Index;

namespace {

constexpr double kDependent = 1e-8;
/// Rows are dropped by updates of A; after this many A is computed again.
constexpr int kUpdates = 50;

/// Diagonal of Φ(ΦᵀΦ)⁻¹Φᵀ of the rows, and (ΦᵀΦ)⁻¹.
void calc_independence(const MatrixXd& Phi, const std::vector<int>& rows, VectorXd& diagonal, MatrixXd& inverse) {
  const MatrixXd some = Phi(rows, Eigen::all);
  const Eigen::HouseholderQR<MatrixXd> qr(some);
  const MatrixXd R = qr.matrixQR().topRows(Phi.cols()).triangularView<Eigen::Upper>();
  const MatrixXd R_inverse =
      R.triangularView<Eigen::Upper>().solve(MatrixXd(MatrixXd::Identity(Phi.cols(), Phi.cols())));
  inverse = R_inverse * R_inverse.transpose();
  diagonal = (some * R_inverse).rowwise().squaredNorm();
}

}  // namespace

std::vector<MeasuredDof> list_measured_dofs(const ModalModel& test, const NodeMatch& match) {
  std::vector<MeasuredDof> dofs;
  for (const auto& [a, b] : match.pairs)
    for (int c = 0; c < 6; ++c)
      if (!test.phi[static_cast<std::size_t>(b)].row(c).isZero(0)) dofs.push_back({a, b, c});
  return dofs;
}

MatrixXd take_dofs(const ModalModel& model, const std::vector<MeasuredDof>& dofs, bool of_test) {
  MatrixXd shapes(static_cast<Index>(dofs.size()), model.num_modes());
  for (std::size_t k = 0; k < dofs.size(); ++k)
    shapes.row(static_cast<Index>(k)) =
        model.phi[static_cast<std::size_t>(of_test ? dofs[k].b : dofs[k].a)].row(dofs[k].component);
  return shapes;
}

ModalModel keep_measured(const ModalModel& a, const std::vector<MeasuredDof>& dofs) {
  ModalModel kept = a;
  for (auto& phi : kept.phi) phi.setZero();
  for (const auto& dof : dofs)
    kept.phi[static_cast<std::size_t>(dof.a)].row(dof.component) =
        a.phi[static_cast<std::size_t>(dof.a)].row(dof.component);
  return kept;
}

MatrixXd calc_serep_mass(const MatrixXd& Phi, const VectorXd& modal_mass) {
  BOUGH_DEMAND(Phi.cols() == modal_mass.size());
  if (Phi.rows() < Phi.cols()) return {};
  const Eigen::JacobiSVD<MatrixXd> svd(Phi, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const VectorXd& sigma = svd.singularValues();
  if (sigma.size() == 0 || !(sigma[sigma.size() - 1] > kDependent * sigma[0])) return {};
  const MatrixXd P = svd.matrixV() * sigma.cwiseInverse().asDiagonal() * svd.matrixU().transpose();
  return P.transpose() * modal_mass.asDiagonal() * P;
}

MatrixXd normalize(const MatrixXd& X, const MatrixXd& M) {
  const VectorXd mass = X.cwiseProduct(M * X).colwise().sum();
  return X * mass.unaryExpr([](double m) { return m > 0 ? 1 / std::sqrt(m) : 0.0; }).asDiagonal();
}

VectorXd calc_comac(const MatrixXd& X, const MatrixXd& Y) {
  const VectorXd cross = X.cwiseProduct(Y).cwiseAbs().rowwise().sum();
  const VectorXd product = X.rowwise().squaredNorm().cwiseProduct(Y.rowwise().squaredNorm());
  return (product.array() > 0).select(cross.cwiseAbs2().array() / product.array(), 0);
}

VectorXd calc_phase_collinearity(const Eigen::MatrixXcd& X) {
  VectorXd collinearity(X.cols());
  for (Index j = 0; j < X.cols(); ++j) {
    const double a = X.col(j).real().squaredNorm(), b = X.col(j).imag().squaredNorm();
    const double c = X.col(j).real().dot(X.col(j).imag());
    const double sum = a + b;
    collinearity[j] = sum > 0 ? ((a - b) * (a - b) + 4 * c * c) / (sum * sum) : 0;
  }
  return collinearity;
}

MatrixXd make_real(const Eigen::MatrixXcd& X) {
  MatrixXd real(X.rows(), X.cols());
  for (Index j = 0; j < X.cols(); ++j) {
    // The angle of largest real part turns Σx² onto the positive real axis.
    const std::complex<double> square = X.col(j).cwiseProduct(X.col(j)).sum();
    real.col(j) = (X.col(j) * std::polar(1.0, -0.5 * std::arg(square))).real();
  }
  return real;
}

std::vector<int> place_sensors(const MatrixXd& Phi, int number, VectorXd& independence) {
  BOUGH_DEMAND(number >= Phi.cols() && number <= Phi.rows());
  std::vector<int> rows(static_cast<std::size_t>(Phi.rows()));
  std::iota(rows.begin(), rows.end(), 0);
  VectorXd diagonal;
  MatrixXd inverse;
  calc_independence(Phi, rows, diagonal, inverse);
  for (int updates = 0; static_cast<int>(rows.size()) > number;) {
    Index dropped = 0;
    diagonal.minCoeff(&dropped);
    const double rest = 1 - diagonal[dropped];
    const auto at = static_cast<std::size_t>(dropped);
    const VectorXd y = inverse * Phi.row(rows[at]).transpose();
    rows.erase(rows.begin() + dropped);
    if (++updates == kUpdates || rest < 0.5) {
      calc_independence(Phi, rows, diagonal, inverse);
      updates = 0;
      continue;
    }
    // (ΦᵀΦ - x xᵀ)⁻¹ by Sherman & Morrison.
    inverse += y * y.transpose() / rest;
    VectorXd left(static_cast<Index>(rows.size()));
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const double cross = Phi.row(rows[k]).dot(y);
      left[static_cast<Index>(k)] = diagonal[static_cast<Index>(k < at ? k : k + 1)] + cross * cross / rest;
    }
    diagonal = std::move(left);
  }
  independence = diagonal;
  return rows;
}

}  // namespace bough::modal
