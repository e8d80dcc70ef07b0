#include "element_checks.hpp"

#include <Eigen/Eigenvalues>

namespace bough::fe::test {

VectorXd make_random(unsigned seed, int n) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  VectorXd u(n);
  for (double& value : u) value = normal(random);
  return u;
}

void expect_sound_stiffness(const SmallModel& m, int rank, double cutoff) {
  const MatrixXd K = m.calc_stiffness();
  const double scale = std::max(K.cwiseAbs().maxCoeff(), 1e-300);
  EXPECT_LT((K - K.transpose()).cwiseAbs().maxCoeff(), 1e-14 * scale);
  EXPECT_LT((K * m.nodes.calc_rigid_modes()).cwiseAbs().maxCoeff(), 1e-12 * scale);
  const VectorXd lambda = Eigen::SelfAdjointEigenSolver<MatrixXd>(K).eigenvalues();
  EXPECT_EQ((lambda.array() > cutoff * scale).count(), rank) << lambda.transpose();
  EXPECT_GE(lambda.minCoeff(), -1e-13 * scale);
}

MatrixXd check_mass(const SmallModel& m, MassKind kind) {
  const MatrixXd M = m.calc_mass(kind), Phi_R = m.nodes.calc_rigid_modes();
  EXPECT_LE((M - M.transpose()).cwiseAbs().maxCoeff(), 1e-14 * M.cwiseAbs().maxCoeff());
  EXPECT_GE(Eigen::SelfAdjointEigenSolver<MatrixXd>(M).eigenvalues().minCoeff(), -1e-14 * M.cwiseAbs().maxCoeff());
  return Phi_R.transpose() * M * Phi_R;
}

void expect_sound_geometric(const SmallModel& m, const VectorXd& u) {
  const int n = m.nodes.num_gdofs();
  const VectorXd u2 = make_random(22, n);
  const MatrixXd K_G = m.calc_geometric_stiffness(u);
  const double scale = std::max(K_G.cwiseAbs().maxCoeff(), 1e-300);
  EXPECT_LT((K_G - K_G.transpose()).cwiseAbs().maxCoeff(), 1e-13 * scale);
  EXPECT_LT((m.calc_geometric_stiffness(2 * u - 3 * u2) - 2 * K_G + 3 * m.calc_geometric_stiffness(u2)).norm(),
            1e-12 * scale * n);
  EXPECT_LT((K_G * m.nodes.calc_rigid_modes().leftCols<3>()).norm(), 1e-12 * scale * n);
}

VectorXd turn_forces(const Vector3d& theta, const VectorXd& f) {
  VectorXd turned(f.size());
  for (Eigen::Index i = 0; i < f.size(); i += 6) {
    turned.segment<3>(i) = theta.cross(f.segment<3>(i));
    turned.segment<3>(i + 3) = 0.5 * theta.cross(f.segment<3>(i + 3));
  }
  return turned;
}

void expect_scaled_additions(const SmallModel& m) {
  for (const auto& element : m.elements) {
    const int n = element->num_dofs();
    MatrixXd once = MatrixXd::Zero(n, n), K = MatrixXd::Constant(n, n, 2.0);
    element->add_stiffness(1, once);
    element->add_stiffness(-3, K);
    EXPECT_LT((K - MatrixXd::Constant(n, n, 2.0) + 3 * once).norm(), 1e-13 * (1 + once.norm()));
    for (MassKind kind : {MassKind::Lumped, MassKind::Consistent}) {
      MatrixXd mass = MatrixXd::Zero(n, n), M = MatrixXd::Constant(n, n, 2.0);
      element->add_mass(kind, 1, mass);
      element->add_mass(kind, -3, M);
      EXPECT_LT((M - MatrixXd::Constant(n, n, 2.0) + 3 * mass).norm(), 1e-13 * (1 + mass.norm()));
    }
    if (const StressState* state = element->stress_state())
      EXPECT_EQ(state->internal_force_names().size(), static_cast<std::size_t>(state->num_internal_forces()));
  }
}

}  // namespace bough::fe::test
