#include "modal/spin.hpp"
#include "modal/tolerances.hpp"

#include <algorithm>
#include <complex>
#include <numbers>

#include <Eigen/Eigenvalues>

namespace bough::modal {

namespace {

constexpr int kFirstSpinLoad = 6;  // of the twelve: ωx² ωy² ωz² ωxωy ωxωz ωyωz

/// Frequencies (cycles) of M = 1, with gyroscopic matrix D = 2ΩG and stiffness K; `diverges`: a root in the right half.
VectorXd solve(const MatrixXd& D, const MatrixXd& K, bool& diverges) {
  const Eigen::Index n = K.rows();
  MatrixXd A = MatrixXd::Zero(2 * n, 2 * n);
  A.topRightCorner(n, n).setIdentity();
  A.bottomLeftCorner(n, n) = -K;
  A.bottomRightCorner(n, n) = -D;
  const Eigen::VectorXcd roots = Eigen::EigenSolver<MatrixXd>(A, false).eigenvalues();
  const double size = std::max(roots.cwiseAbs().maxCoeff(), detail::kTiny);
  diverges = (roots.real().array() > 1e-6 * size).any();
  // Roots come as ± pairs; each pair is one motion.
  std::vector<double> frequencies;
  for (const auto& root : roots) frequencies.push_back(std::abs(root.imag()) / (2 * std::numbers::pi));
  std::sort(frequencies.begin(), frequencies.end());
  VectorXd result(n);
  for (Eigen::Index i = 0; i < n; ++i) result[i] = frequencies[static_cast<std::size_t>(2 * i)];
  return result;
}

}  // namespace

SpinFrequencies calc_spin_frequencies(const records::FlexBody& body, const Vector3d& axis, const VectorXd& rates,
                                      int most_modes) {
  const Eigen::Index n = body.num_modes();
  const auto& set = body.integrals();
  MatrixXd G = MatrixXd::Zero(n, n), S = MatrixXd::Zero(n, n), K_G = MatrixXd::Zero(n, n);
  for (Eigen::Index j = 0; j < n && !set.empty(); ++j) {
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto sj = static_cast<std::size_t>(j), sk = static_cast<std::size_t>(k);
      G(j, k) = axis.dot(set.gamma2[sk].col(j));
      S(j, k) = axis.dot(set.gamma4[sj][sk] * axis);
    }
  }
  const double weights[] = {axis.x() * axis.x(), axis.y() * axis.y(), axis.z() * axis.z(),
                            axis.x() * axis.y(), axis.x() * axis.z(), axis.y() * axis.z()};
  SpinFrequencies result;
  result.has_stiffness = true;
  for (std::size_t i = 0; i < 6; ++i) {
    if (weights[i] == 0) continue;
    if (body.kg_inertial_computed[kFirstSpinLoad + i])
      K_G += weights[i] * body.kg_inertial[kFirstSpinLoad + i];
    else
      result.has_stiffness = false;
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> modes(body.modal_stiffness, body.modal_mass);
  const Eigen::Index k = std::min<Eigen::Index>(n, most_modes);
  const MatrixXd V = modes.eigenvectors().leftCols(k);
  const MatrixXd K = modes.eigenvalues().head(k).asDiagonal();
  const MatrixXd g = V.transpose() * G * V;
  MatrixXd s = V.transpose() * S * V, kg = V.transpose() * K_G * V;
  s = 0.5 * (s + s.transpose()).eval();
  kg = 0.5 * (kg + kg.transpose()).eval();
  result.rate = rates;
  result.num_modes = static_cast<int>(k);
  result.frequency_hz.resize(rates.size(), k);
  result.without_hz.resize(rates.size(), k);
  for (Eigen::Index r = 0; r < rates.size(); ++r) {
    const double rate = rates[r];
    bool diverges = false, unused = false;
    result.frequency_hz.row(r) = solve(2 * rate * g, K + rate * rate * (kg - s), diverges).transpose();
    result.without_hz.row(r) = solve(2 * rate * g, K - rate * rate * s, unused).transpose();
    result.diverges.push_back(diverges);
  }
  return result;
}

}  // namespace bough::modal
