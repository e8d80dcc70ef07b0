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

/// Displacements and rotations of an element's nodes.
struct FiniteMotion {
  VectorXd u;
  std::vector<Matrix3d> R;

  /// Displacements and spins `step` more.
  FiniteMotion move(const FrameCheck& check, const VectorXd& step) const {
    FiniteMotion moved = *this;
    moved.u += step;
    for (int k = 0; k < check.num_nodes(); ++k) {
      auto& R_k = moved.R[static_cast<std::size_t>(k)];
      if (check.get_rotation(k) >= 0) R_k = calc_rotation_exp(step.segment<3>(check.get_rotation(k))) * R_k;
    }
    return moved;
  }
  FiniteForces calc(const FrameCheck& check) const { return check.corotational.calc_finite(u, R); }
};

/// Forces are the slope of the energy, their slope is K, a turned element has turned forces, and small motions are
/// those of the series.
void expect_finite_forces(const FrameCheck& check, const VectorXd& a, const VectorXd& b) {
  const VectorXd& size = check.corotational.K().diagonal();
  const double length = std::max(check.corotational.arms().colwise().norm().maxCoeff(), 1e-3);
  VectorXd unit = VectorXd::Ones(a.size());  // translations by the size of the element
  for (int k = 0; k < check.num_nodes(); ++k) unit.segment<3>(check.get_translation(k)) *= length;
  FiniteMotion rest{VectorXd::Zero(a.size()),
                    std::vector<Matrix3d>(check.corotational.grids().size(), Matrix3d::Identity())};
  const Matrix3d turn = calc_rotation_exp(Vector3d(1.1, -0.7, 1.9));
  FiniteMotion turned = rest;
  for (int k = 0; k < check.num_nodes(); ++k) {
    turned.u.segment<3>(check.get_translation(k)) = turn * check.get_arm(k) - check.get_arm(k) + Vector3d(3, -2, 5);
    if (check.get_rotation(k) >= 0) turned.R[static_cast<std::size_t>(k)] = turn;
  }
  const double stiff = (size.array() * unit.array().square()).maxCoeff();
  EXPECT_LT((turned.calc(check).f.array() * unit.array()).abs().maxCoeff(), 1e-12 * stiff) << check.element.card();

  const FiniteMotion bent = turned.move(check, VectorXd(0.1 * unit.cwiseProduct(a)));
  const FiniteForces forces = bent.calc(check);
  const double h = 2e-5;
  const VectorXd step = h * unit.cwiseProduct(b);
  const FiniteForces after = bent.move(check, step).calc(check), before = bent.move(check, VectorXd(-step)).calc(check);
  EXPECT_NEAR((after.energy - before.energy) / 2, forces.f.dot(step), 1e-6 * h * stiff) << check.element.card();
  const VectorXd slope = (after.f - before.f).cwiseProduct(unit) / 2, expected = (forces.K * step).cwiseProduct(unit);
  EXPECT_LT((slope - expected).norm(), 1e-6 * expected.norm()) << check.element.card();

  const VectorXd small = 0.01 * unit.cwiseProduct(a);
  MatrixXd curve = MatrixXd::Zero(a.size(), kSeriesTop);
  curve.col(0) = small;
  const VectorXd series = check.corotational.calc_forces(curve).rowwise().sum();
  VectorXd exact = rest.move(check, small).calc(check).f;
  for (int k = 0; k < check.num_nodes(); ++k) {
    if (check.get_rotation(k) < 0) continue;
    const Vector3d theta = small.segment<3>(check.get_rotation(k));
    exact.segment<3>(check.get_rotation(k)) =
        (calc_rotation_tangent(theta).transpose() * exact.segment<3>(check.get_rotation(k))).eval();
  }
  EXPECT_LT((series - exact).cwiseProduct(unit).norm(), 1e-7 * exact.cwiseProduct(unit).norm()) << check.element.card();
}

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
    expect_finite_forces(check, a, b);
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
