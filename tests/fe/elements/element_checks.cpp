#include "element_checks.hpp"

#include <array>

#include <Eigen/Eigenvalues>

#include "fe/corotational/corotational_element.hpp"

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

namespace {

/// One element and what its frame is made of.
struct FrameCheck {
  FrameCheck(const Element& e, const std::vector<Node>& nodes) : element(e), corotational(e, nodes) {}

  int num_nodes() const { return static_cast<int>(corotational.arms().cols()); }
  Vector3d get_arm(int k) const { return corotational.arms().col(k); }
  int get_translation(int k) const { return corotational.translations()[static_cast<std::size_t>(k)]; }
  int get_rotation(int k) const { return corotational.rotations()[static_cast<std::size_t>(k)]; }

  VectorXd calc_rotation(const Vector3d& omega) const {
    VectorXd u = VectorXd::Zero(element.num_dofs());
    for (int k = 0; k < num_nodes(); ++k) {
      u.segment<3>(get_translation(k)) = omega.cross(get_arm(k));
      if (get_rotation(k) >= 0) u.segment<3>(get_rotation(k)) = omega;
    }
    return u;
  }

  /// u without the rotation of the frame.
  VectorXd remove_rotation(const VectorXd& u) const {
    Matrix3d H = corotational.arms() * corotational.arms().transpose();
    Vector3d axis = Vector3d::Zero();
    for (int k = 0; k < num_nodes(); ++k) {
      axis += get_arm(k).cross(u.segment<3>(get_translation(k)));
      if (get_rotation(k) < 0) continue;
      H += corotational.rotation_weight() * Matrix3d::Identity();
      axis += 2 * corotational.rotation_weight() * u.segment<3>(get_rotation(k));
    }
    const Matrix3d A = H.trace() * Matrix3d::Identity() - H;
    return u - calc_rotation(A.completeOrthogonalDecomposition().solve(axis));
  }

  /// ω×f of forces, ½ ω×m of moments.
  VectorXd turn(const Vector3d& omega, const VectorXd& f) const {
    VectorXd turned = VectorXd::Zero(f.size());
    for (int k = 0; k < num_nodes(); ++k) {
      turned.segment<3>(get_translation(k)) = omega.cross(f.segment<3>(get_translation(k)));
      if (get_rotation(k) >= 0) turned.segment<3>(get_rotation(k)) = 0.5 * omega.cross(f.segment<3>(get_rotation(k)));
    }
    return turned;
  }

  double calc_third(const VectorXd& a, const VectorXd& b, const VectorXd& c) const {
    MatrixXd u = MatrixXd::Zero(a.size(), 2 * kSeriesTop);
    u.col(0) = a + b;
    u.col(kSeriesTop) = a - b;
    const MatrixXd f = corotational.calc_forces(u);
    return 0.5 * c.dot(f.col(1) - f.col(kSeriesTop + 1));
  }

  MatrixXd calc_geometric(const VectorXd& a) const {
    const StressState& state = *element.stress_state();
    VectorXd force = VectorXd::Zero(state.num_internal_forces());
    state.calc_internal_forces(a, force);
    MatrixXd K_G = MatrixXd::Zero(a.size(), a.size());
    state.add_geometric_stiffness(force, 1, K_G);
    return K_G;
  }

  /// V‴(a, b, c) and the sum of K_G, relative to the size of K_G.
  std::array<double, 2> compare(const VectorXd& a, const VectorXd& b, const VectorXd& c) const {
    const MatrixXd Ka = calc_geometric(a), Kb = calc_geometric(b), Kc = calc_geometric(c);
    const double sum = b.dot(Ka * c) + a.dot(Kb * c) + a.dot(Kc * b);
    const double scale =
        Ka.norm() * b.norm() * c.norm() + Kb.norm() * a.norm() * c.norm() + Kc.norm() * a.norm() * b.norm();
    return {calc_third(a, b, c) / scale, sum / scale};
  }

  const Element& element;
  CorotationalElement corotational;
};

}  // namespace

void expect_third_derivative_of_geometric(const SmallModel& m, double tolerance) {
  std::vector<Node> nodes;
  for (int k = 0; k < m.nodes.num_nodes(); ++k) nodes.push_back(m.nodes.node(k));
  for (const auto& element : m.elements) {
    if (!element->stress_state()) continue;
    const FrameCheck check(*element, nodes);
    ASSERT_TRUE(check.corotational.follows_nodes()) << element->card();
    const int n = element->num_dofs();
    const VectorXd a = make_random(71, n), b = make_random(72, n), c = make_random(73, n);
    const auto local = check.compare(check.remove_rotation(a), check.remove_rotation(b), check.remove_rotation(c));
    EXPECT_NEAR(local[0], local[1], 1e-9) << element->card();
    const auto whole = check.compare(a, b, c);
    EXPECT_NEAR(whole[0], whole[1], tolerance) << element->card();
    const Vector3d omega(0.3, -0.5, 0.8);
    const VectorXd Kb = check.corotational.K() * b, Kc = check.corotational.K() * c;
    EXPECT_NEAR(check.calc_third(b, c, check.calc_rotation(omega)),
                check.turn(omega, Kb).dot(c) + check.turn(omega, Kc).dot(b),
                1e-9 * (Kb.norm() * c.norm() + Kc.norm() * b.norm()))
        << element->card();
  }
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
