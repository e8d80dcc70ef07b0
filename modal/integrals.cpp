#include "bough/modal/integrals.hpp"

#include <array>

#include "bough/base/rotation.hpp"
#include "bough/fe/blas.hpp"

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

MassTimes make_mass_times(const fe::Model& model, fe::MassKind kind) {
  return [&model, kind](const MatrixXd& X) { return fe::calc_mass_times(model, kind, X); };
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
  // G[a](b) = Σ_k A^T_kj(a) φ_kl(b) for all pairs at once: Γ2 and Γ4 are its antisymmetric part and trace.
  std::array<MatrixXd, 9> G;
  G.fill(MatrixXd::Zero(n, n));
  for (int node = 0; node < dofs.num_nodes(); ++node) {
    const Vector3d p = dofs.xyz.row(node).transpose() - reference;
    const MatrixXd A = dofs.gather(M_Phi, node), phi = dofs.gather(Phi, node);
    g.gamma0 += A.topRows(3);
    g.gamma1 += A.bottomRows(3) + skew(p) * A.topRows(3);
    for (int j = 0; j < n; ++j) {
      const Vector3d a = A.col(j).head<3>();
      g.gamma3[j] += p.dot(a) * Matrix3d::Identity() - a * p.transpose();
    }
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) G[3 * a + b] += A.row(a).transpose() * phi.row(b);
  }
  for (int j = 0; j < n; ++j) {
    for (int k = 0; k < n; ++k) {
      Matrix3d outer;
      for (int i = 0; i < 9; ++i) outer(i / 3, i % 3) = G[i](j, k);
      g.gamma2[j].col(k) << outer(1, 2) - outer(2, 1), outer(2, 0) - outer(0, 2), outer(0, 1) - outer(1, 0);
      g.gamma4[j][k] = outer.trace() * Matrix3d::Identity() - outer;
    }
  }
  return g;
}

MassIntegrals calc_exact_integrals(const fe::Model& model, fe::MassKind kind, const MatrixXd& Phi,
                                   const Vector3d& reference) {
  return calc_exact_integrals(NodalDofs::from_model(model), make_mass_times(model, kind), Phi, reference);
}

MassIntegrals calc_exact_integrals(const NodalDofs& dofs, const MassTimes& mass_times, const MatrixXd& Phi,
                                   const Vector3d& reference) {
  BOUGH_DEMAND(Phi.rows() == dofs.num_dofs);
  const auto n = static_cast<int>(Phi.cols());
  // Columns: Φ_R (6), e_a×φ_j (3n, j + a n), Φ (n).
  MatrixXd B = MatrixXd::Zero(Phi.rows(), 6 + 4 * n);
  B.leftCols(6) = dofs.calc_rigid_modes(reference);
  B.rightCols(n) = Phi;
  for (int node = 0; node < dofs.num_nodes(); ++node) {
    MatrixXd turned = MatrixXd::Zero(6, n);
    const MatrixXd phi = dofs.gather(Phi, node).topRows(3);
    for (int a = 0; a < 3; ++a) {
      turned.topRows(3) = skew(Vector3d::Unit(a)) * phi;
      dofs.scatter(turned, node, B.middleCols(6 + a * n, n));
    }
  }
  const MatrixXd M_turned = mass_times(B.rightCols(4 * n));
  MatrixXd gram(6 + 4 * n, 4 * n);
  fe::multiply_dense(true, B, M_turned, 0, gram);
  const auto turned = [n](int a, int j) { return a * n + j; };
  const auto plain = [n](int j) { return 3 * n + j; };

  MassIntegrals g = make_empty(n);
  g.gamma0 = gram.block(0, 3 * n, 3, n);
  g.gamma1 = gram.block(3, 3 * n, 3, n);
  for (int j = 0; j < n; ++j) {
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) g.gamma3[j](a, b) = gram(3 + a, turned(b, j));
      for (int k = 0; k < n; ++k) {
        g.gamma2[j](a, k) = gram(6 + turned(a, j), plain(k));
        for (int b = 0; b < 3; ++b) g.gamma4[j][k](a, b) = gram(6 + turned(a, k), turned(b, j));
      }
    }
  }
  return g;
}

}  // namespace bough::modal
