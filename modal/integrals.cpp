#include "modal/integrals.hpp"

#include <algorithm>
#include <cmath>

#include "base/rotation.hpp"
#include "fe/linear/blas.hpp"
#include "fe/linear/factor.hpp"
#include "fe/loads/arm_strains.hpp"
#include "fe/loads/inertial_loads.hpp"
#include "modal/strained_integrals.hpp"

namespace bough::modal {

namespace {

MassIntegrals make_empty(int num_modes) {
  MassIntegrals g;
  g.gamma0 = MatrixXd::Zero(3, num_modes);
  g.gamma1 = MatrixXd::Zero(3, num_modes);
  g.gamma2.assign(num_modes, MatrixXd::Zero(3, num_modes));
  g.gamma3.assign(num_modes, Matrix3d::Zero());
  g.gamma4.assign(num_modes, std::vector<Matrix3d>(num_modes, Matrix3d::Zero()));
  return g;
}

/// Rows of one component (0..5) at every node: p x m, zero if the dof is missing.
MatrixXd take_component(const NodalDofs& dofs, const MatrixXd& X, int component) {
  MatrixXd part(dofs.num_nodes(), X.cols());
  for (Eigen::Index j = 0; j < X.cols(); ++j)
    for (Eigen::Index k = 0; k < part.rows(); ++k) {
      const int row = dofs.row(k, component);
      part(k, j) = row >= 0 ? X(row, j) : 0;
    }
  return part;
}

/// Translations side by side: p x 3m, x of every column first.
MatrixXd take_translations(const NodalDofs& dofs, const MatrixXd& X) {
  MatrixXd parts(dofs.num_nodes(), 3 * X.cols());
  for (int a = 0; a < 3; ++a) parts.middleCols(a * X.cols(), X.cols()) = take_component(dofs, X, a);
  return parts;
}

/// e_a×φ_j (3n columns, j + a n; rotations zero), then Φ itself (n).
MatrixXd make_turned(const NodalDofs& dofs, const MatrixXd& Phi) {
  const Eigen::Index n = Phi.cols();
  MatrixXd X = MatrixXd::Zero(Phi.rows(), 4 * n);
  X.rightCols(n) = Phi;
  const auto at = [](int a) { return a % 3; };
  for (Eigen::Index j = 0; j < n; ++j)
    for (int a = 0; a < 3; ++a)
      for (Eigen::Index k = 0; k < dofs.num_nodes(); ++k) {
        const int first = dofs.row(k, at(a + 1)), second = dofs.row(k, at(a + 2));
        if (first >= 0 && second >= 0) X(first, a * n + j) = -Phi(second, j), X(second, a * n + j) = Phi(first, j);
      }
  return X;
}

MassTimes make_mass_times(const fe::Model& model, fe::MassKind kind) {
  return [&model, kind](const MatrixXd& X) { return fe::calc_mass_times(model, kind, X); };
}

/// Returns true if M is one mass of the nodes in all directions, and none of rotations. Then the Gram matrix of e_a×u_j
/// is made of the products of components, as the momentum formulas are: both are the same, and these a sixth of the
/// work.
bool moves_alike(const NodalDofs& dofs, const MassTimes& mass_times) {
  constexpr double kSame = 1e-13;
  MatrixXd X = MatrixXd::Zero(dofs.num_dofs, 4);  // different numbers that cannot cancel; rotations last
  for (Eigen::Index k = 0; k < dofs.num_nodes(); ++k)
    for (int a = 0; a < 6; ++a)
      if (const int row = dofs.row(k, a); row >= 0)
        X(row, std::min(a, 3)) = 1 + std::fmod(0.6180339887498949 * static_cast<double>(k + 1), 1.0);
  MatrixXd M_X = mass_times(X);
  if (!M_X.col(3).isZero(0)) return false;
  for (Eigen::Index k = 0; k < dofs.num_nodes(); ++k) {
    if ((dofs.row.row(k).array() < 0).any()) return false;
    const double momentum = M_X(dofs.row(k, 0), 0);
    for (int a = 0; a < 6; ++a)
      for (int c = 0; c < 3; ++c)
        if (!(std::abs(M_X(dofs.row(k, a), c) - (a == c ? momentum : 0)) <= kSame * std::abs(momentum))) return false;
    M_X(dofs.row.row(k), Eigen::all).setZero();
  }
  return M_X.isZero(0);  // no coupling of the node to scalar or modal DOFs
}

/// Adds what carried masses have: gram as calc_carried_gram gives it.
void add_carried(MatrixXd gram, const Vector3d& reference, MassIntegrals& g) {
  const auto n = g.gamma0.cols();
  gram.middleRows<3>(1) -= reference * gram.row(0);  // x from the reference point
  gram.middleCols<3>(1) -= gram.col(0) * reference.transpose();
  const auto at = [n](int a, Eigen::Index j) { return 4 + a * n + j; };
  const auto cross = [](const Matrix3d& outer) {  // of Σ a bᵀ: Σ a×b
    return Vector3d(outer(1, 2) - outer(2, 1), outer(2, 0) - outer(0, 2), outer(0, 1) - outer(1, 0));
  };
  Matrix3d outer;
  for (Eigen::Index j = 0; j < n; ++j) {
    for (int a = 0; a < 3; ++a) g.gamma0(a, j) += gram(0, at(a, j));
    for (int i = 0; i < 9; ++i) outer(i / 3, i % 3) = gram(1 + i / 3, at(i % 3, j));
    g.gamma1.col(j) += cross(outer);
    g.gamma3[static_cast<std::size_t>(j)] += outer.trace() * Matrix3d::Identity() - outer.transpose();
    for (Eigen::Index k = 0; k < n; ++k) {
      for (int i = 0; i < 9; ++i) outer(i / 3, i % 3) = gram(at(i / 3, j), at(i % 3, k));
      g.gamma2[static_cast<std::size_t>(j)].col(k) += cross(outer);
      g.gamma4[static_cast<std::size_t>(j)][static_cast<std::size_t>(k)] +=
          outer.trace() * Matrix3d::Identity() - outer;
    }
  }
}

}  // namespace

MassIntegrals calc_momentum_integrals(const fe::Model& model, fe::MassKind kind, const MatrixXd& Phi,
                                      const Vector3d& reference) {
  return calc_momentum_integrals(NodalDofs::from_model(model), make_mass_times(model, kind), Phi, reference);
}

MassIntegrals calc_momentum_integrals(const NodalDofs& dofs, const MassTimes& mass_times, const MatrixXd& Phi,
                                      const Vector3d& reference) {
  BOUGH_DEMAND(Phi.rows() == dofs.num_dofs);
  const auto n = static_cast<int>(Phi.cols());
  const MatrixXd M_Phi = mass_times(Phi);
  MassIntegrals g = make_empty(n);
  const MatrixXd p = dofs.xyz.rowwise() - reference.transpose(), A = take_translations(dofs, M_Phi);
  MatrixXd p_A(3, 3 * n), G(3 * n, 3 * n);  // Σ_k p_k(b) A_kj(a), Σ_k A_kj(a) φ_kl(b), x of every mode first
  linear::multiply_dense(true, p, A, 0, p_A);
  linear::multiply_dense(true, A, take_translations(dofs, Phi), 0, G);
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    g.gamma0.row(a) = A.middleCols(a * n, n).colwise().sum();
    g.gamma1.row(a) =
        take_component(dofs, M_Phi, 3 + a).colwise().sum() + p_A.block(b, c * n, 1, n) - p_A.block(c, b * n, 1, n);
  }
  for (int j = 0; j < n; ++j) {
    Matrix3d outer;
    for (int i = 0; i < 9; ++i) outer(i / 3, i % 3) = p_A(i % 3, i / 3 * n + j);
    g.gamma3[j] = outer.trace() * Matrix3d::Identity() - outer;
    // Γ2 and Γ4 are the antisymmetric part and trace of G.
    for (int k = 0; k < n; ++k) {
      for (int i = 0; i < 9; ++i) outer(i / 3, i % 3) = G(i / 3 * n + j, i % 3 * n + k);
      g.gamma2[j].col(k) << outer(1, 2) - outer(2, 1), outer(2, 0) - outer(0, 2), outer(0, 1) - outer(1, 0);
      g.gamma4[j][k] = outer.trace() * Matrix3d::Identity() - outer;
    }
  }
  return g;
}

namespace {

MassIntegrals calc_integrals(const fe::Model& model, fe::MassKind kind, const MatrixXd& Phi, const Vector3d& reference,
                             const MatrixXd& strain) {
  const auto M = fe::assemble_grid_mass(model, kind);
  const auto mass_times = [&M](const MatrixXd& X) -> MatrixXd { return linear::multiply(M, X); };
  const auto dofs = NodalDofs::from_model(model);
  MassIntegrals g = moves_alike(dofs, mass_times) ? calc_momentum_integrals(dofs, mass_times, Phi, reference)
                                                  : calc_exact_integrals(dofs, mass_times, Phi, reference);
  add_carried(fe::calc_strained_gram(model, kind, Phi, strain), reference, g);
  return g;
}

}  // namespace

MassIntegrals calc_exact_integrals(const fe::Model& model, fe::MassKind kind, const MatrixXd& Phi,
                                   const Vector3d& reference) {
  return calc_integrals(model, kind, Phi, reference, MatrixXd::Zero(9, 0));
}

MassIntegrals calc_strained_integrals(const fe::Model& model, fe::MassKind kind, const MatrixXd& Phi,
                                      const MatrixXd& strain) {
  return calc_integrals(model, kind, Phi, Vector3d::Zero(), strain);
}

MassIntegrals calc_named_integrals(const fe::Model& model, fe::MassKind kind, const MatrixXd& Phi) {
  if (kind == fe::MassKind::Lumped && !fe::has_approximate_mass(model, kind))
    return calc_exact_integrals(model, kind, Phi);
  return calc_momentum_integrals(model, kind, Phi);
}

MassIntegrals calc_exact_integrals(const NodalDofs& dofs, const MassTimes& mass_times, const MatrixXd& Phi,
                                   const Vector3d& reference) {
  BOUGH_DEMAND(Phi.rows() == dofs.num_dofs);
  const auto n = static_cast<int>(Phi.cols());
  const MatrixXd X = make_turned(dofs, Phi), Phi_R = dofs.calc_rigid_modes(reference);
  MatrixXd gram_R(6, 4 * n), gram(3 * n, 4 * n);  // of Φ_R, and of e_a×φ_j, with X
  for (int a = 0; a < 4; ++a) {                   // a quarter of M X at a time: less memory
    const MatrixXd M_X = mass_times(X.middleCols(a * n, n));
    linear::multiply_dense(true, Phi_R, M_X, 0, gram_R.middleCols(a * n, n));
    linear::multiply_dense(true, X.leftCols(3 * n), M_X, 0, gram.middleCols(a * n, n));
  }
  const auto turned = [n](int a, int j) { return a * n + j; };
  const auto plain = [n](int j) { return 3 * n + j; };

  MassIntegrals g = make_empty(n);
  g.gamma0 = gram_R.topRightCorner(3, n);
  g.gamma1 = gram_R.bottomRightCorner(3, n);
  for (int j = 0; j < n; ++j) {
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) g.gamma3[j](a, b) = gram_R(3 + a, turned(b, j));
      for (int k = 0; k < n; ++k) {
        g.gamma2[j](a, k) = gram(turned(a, j), plain(k));
        for (int b = 0; b < 3; ++b) g.gamma4[j][k](a, b) = gram(turned(a, k), turned(b, j));
      }
    }
  }
  return g;
}

}  // namespace bough::modal
