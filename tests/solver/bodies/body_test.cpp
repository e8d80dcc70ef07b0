#include "solver/bodies/body.hpp"

#include <gtest/gtest.h>

#include "tests/solver/bodies/hamel.hpp"
#include "tests/solver/support/models.hpp"

namespace bough::solver::testing {
namespace {

VectorXd stack(const Vector3d& v, const Vector3d& w, const VectorXd& eta_dot) {
  VectorXd V(6 + eta_dot.size());
  V << v, w, eta_dot;
  return V;
}

// The body's own T = ½ Vᵀ M(η) V.
double calc_kinetic(const Body& body, const VectorXd& V, const VectorXd& eta) {
  BodyInertia x = body.make_inertia();
  body.calc_inertia(V.segment<3>(3), eta, V.tail(eta.size()), x);
  return 0.5 * V.dot(x.make_M() * V);
}

class BodyTest : public ::testing::TestWithParam<int> {
 protected:
  BodyTest() {
    Random random(40 + static_cast<unsigned>(GetParam()));
    eta_ = random.vector_n(GetParam(), 0.4);
    V_ = stack(random.vector(), random.vector(), random.vector_n(GetParam(), 1));
  }
  PointBody points_ = make_point_body(GetParam(), 7);
  records::FlexBody flex_ = points_.make_record("p");
  VectorXd eta_, V_;
};

TEST_P(BodyTest, KineticEnergyAgreesWithThePointsToSecondOrder) {
  const Body body = Body::make_flexible(flex_, -1, true, {});
  // The record knows T to second order in η (η̇ counts as η), so the difference falls with the cube of the scale.
  double previous = 0;
  for (const double s : {1e-1, 1e-2}) {
    VectorXd V = V_;
    V.tail(GetParam()) *= s;
    const double exact = points_.calc_kinetic(V.head<3>(), V.segment<3>(3), s * eta_, V.tail(GetParam()));
    const double difference = std::abs(calc_kinetic(body, V, s * eta_) - exact);
    if (previous > 0) {
      EXPECT_LT(difference, 1.5e-3 * previous + 1e-13);
    }
    previous = difference;
  }
  EXPECT_GT(previous, 0);
}

TEST_P(BodyTest, WithoutSecondOrderFieldTheKineticEnergyIsExact) {
  const PointBody points = make_point_body(GetParam(), 11, 0);
  const Body body = Body::make_flexible(points.make_record("p"), -1, true, {});
  const double exact = points.calc_kinetic(V_.head<3>(), V_.segment<3>(3), eta_, V_.tail(GetParam()));
  EXPECT_NEAR(calc_kinetic(body, V_, eta_), exact, 1e-13 * exact);
}

// Damping belongs to the motions: other coordinates of the same body decay alike.
TEST_P(BodyTest, DampingRatiosAreThoseOfTheMotionsInAnyCoordinates) {
  const int n = GetParam();
  std::vector<double> ratios;
  for (int j = 0; j < n; ++j) ratios.push_back(0.01 * (j + 1));
  const MatrixXd &M = flex_.modal_mass, &K = flex_.modal_stiffness;
  const Body body = Body::make_flexible(flex_, -1, false, ratios);
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> motions(K, M);
  const MatrixXd D = motions.eigenvectors().transpose() * body.D() * motions.eigenvectors();
  for (int j = 0; j < n; ++j) {
    const double omega = std::sqrt(motions.eigenvalues()[j]);
    EXPECT_NEAR(D(j, j), 2 * ratios[static_cast<size_t>(j)] * omega, 1e-12 * omega);
    EXPECT_LT(D.col(j).cwiseAbs().sum() - D(j, j), 1e-12 * omega);
  }
}

TEST_P(BodyTest, MassMatrixIsSymmetricAndPositive) {
  const Body body = Body::make_flexible(flex_, -1, true, {});
  BodyInertia x = body.make_inertia();
  body.calc_inertia(V_.segment<3>(3), eta_, V_.tail(GetParam()), x);
  EXPECT_EQ((x.M6 - x.M6.transpose()).cwiseAbs().maxCoeff(), 0);
  EXPECT_EQ(Eigen::LLT<MatrixXd>(x.make_M()).info(), Eigen::Success);
}

// Hamel's equations by differencing T numerically, against M(η) [a; α; η̈] + h (both with and without stiffening).
TEST_P(BodyTest, EquationsOfMotionFollowFromTheKineticEnergy) {
  const int n = GetParam(), size = 6 + n;
  for (const bool stiffening : {true, false}) {
    const Body body = Body::make_flexible(flex_, -1, stiffening, {});
    Random random(5);
    const VectorXd V_dot = random.vector_n(size);
    const double h = 1e-5;
    auto calc_momentum = [&](const VectorXd& V, const VectorXd& eta) {
      BodyInertia x = body.make_inertia();
      body.calc_inertia(V.segment<3>(3), eta, V.tail(n), x);
      return VectorXd(x.make_M() * V);
    };
    const VectorXd eta_dot = V_.tail(n), eta_ddot = V_dot.tail(n);
    auto at = [&](double t) { return calc_momentum(V_ + t * V_dot, eta_ + t * eta_dot + 0.5 * t * t * eta_ddot); };
    VectorXd expected = calc_hamel_rates(V_, at, h);
    const Vector3d v = V_.head<3>(), w = V_.segment<3>(3);
    for (int j = 0; j < n; ++j) {
      const VectorXd step = 1e-4 * VectorXd::Unit(n, j);
      expected[6 + j] -= (calc_kinetic(body, V_, eta_ + step) - calc_kinetic(body, V_, eta_ - step)) / 2e-4;
    }
    expected.tail(n) += points_.K * eta_ + points_.D * eta_dot;

    BodyInertia x = body.make_inertia();
    body.calc_inertia(w, eta_, eta_dot, x);
    VectorXd acceleration = V_dot;
    acceleration.head<3>() += w.cross(v);  // inertial acceleration of Bo
    const VectorXd actual = x.make_M() * acceleration + x.h;
    EXPECT_LT((actual - expected).norm(), 1e-8 * expected.norm()) << "stiffening " << stiffening;
  }
}

TEST_P(BodyTest, NodeVelocityAndBiasAreTheRatesOfItsPlace) {
  const Body body = Body::make_flexible(flex_, -1, true, {});
  const int n = GetParam();
  Random random(9);
  const VectorXd eta_dot = random.vector_n(n), eta_ddot = random.vector_n(n);
  const Node& node = body.nodes()[3];
  const double h = 1e-4;
  auto at = [&](double t) {
    NodeInBody k;
    calc_node_in_body(node, eta_ + t * eta_dot + 0.5 * t * t * eta_ddot, eta_dot + t * eta_ddot, k);
    return k;
  };
  const NodeInBody k = at(0), plus = at(h), minus = at(-h);
  Matrix6Xd J(6, n);
  Vector3d place, turned;
  calc_node_position(node, eta_, place, turned, J);
  J.bottomRows<3>() = (k.T * J.bottomRows<3>()).eval();
  EXPECT_LT((place - k.r).norm() + (turned - k.theta).norm(), 1e-15);
  const Vector3d v = (plus.r - minus.r) / (2 * h), a = (plus.v - minus.v) / (2 * h),
                 alpha = (plus.w - minus.w) / (2 * h);
  const Matrix3d w_skew = (plus.R_BK - minus.R_BK) / (2 * h) * k.R_BK.transpose();
  EXPECT_LT((k.v - v).norm(), 1e-7);
  EXPECT_LT((J.topRows<3>() * eta_dot - v).norm(), 1e-7);
  EXPECT_LT((skew(k.w) - w_skew).norm(), 1e-7);
  EXPECT_LT((J.bottomRows<3>() * eta_dot - k.w).norm(), 1e-13);
  EXPECT_LT((J.topRows<3>() * eta_ddot + k.gamma_t - a).norm(), 1e-7);
  EXPECT_LT((J.bottomRows<3>() * eta_ddot + k.gamma_r - alpha).norm(), 1e-7);
  // The place itself: p + φη + ½ηᵀgη of the point it was made from.
  Vector3d r = points_.p[2] + points_.phi[2] * eta_;
  for (int c = 0; c < 3; ++c) r[c] += 0.5 * eta_.dot(points_.g[2][static_cast<size_t>(c)] * eta_);
  EXPECT_LT((k.r - r).norm(), 1e-14);
  Vector3d theta = points_.psi[2] * eta_;
  for (int c = 0; c < 3; ++c) theta[c] += 0.5 * eta_.dot(points_.g_theta[2][static_cast<size_t>(c)] * eta_);
  EXPECT_LT((k.R_BK - calc_rotation_exp(theta)).norm(), 1e-14);
  // A wrench does the same work through the generalized force as at the node.
  const Vector3d f = random.vector(), t = random.vector();
  VectorXd Q = VectorXd::Zero(n);
  add_node_generalized_force(node, eta_, k.T, f, t, Q);
  EXPECT_NEAR(Q.dot(eta_dot), f.dot(k.v) + t.dot(k.w), 1e-13);
}

INSTANTIATE_TEST_SUITE_P(Modes, BodyTest, ::testing::Values(1, 2, 5));

TEST(FlexibleBody, FewerModesAreTheLeadingOnes) {
  const auto flex = make_point_body(5, 7).make_record("p");
  const Body all = Body::make_flexible(flex, -1, true, {}), fewer = Body::make_flexible(flex, 3, true, {});
  Random random(3);
  VectorXd eta = random.vector_n(5, 0.3), V = random.vector_n(11);
  eta.tail(2).setZero();
  V.tail(2).setZero();
  EXPECT_EQ(fewer.num_modes(), 3);
  EXPECT_NEAR(calc_kinetic(fewer, V.head(9), eta.head(3)), calc_kinetic(all, V, eta), 1e-12);
}

TEST(RigidBody, MassMatrixMovesTheInertiaToTheOrigin) {
  const Vector3d cg(0.1, -0.2, 0.3), w(0.4, 0.5, -0.6), v(1, 2, 3);
  Matrix3d J;
  J << 2, 0.1, 0.2, 0.1, 3, 0.3, 0.2, 0.3, 4;
  const Body body = Body::make_rigid(2.5, cg, J);
  VectorXd V(6);
  V << v, w;
  const double by_cg = 0.5 * 2.5 * (v + w.cross(cg)).squaredNorm() + 0.5 * w.dot(J * w);
  EXPECT_NEAR(0.5 * V.dot(body.M6() * V), by_cg, 1e-14);
}

TEST(FlexibleBody, DampingRatiosReplaceTheFilesDamping) {
  const PointBody points = make_point_body(3, 21);
  const auto flex = points.make_record("p");
  const Body uniform = Body::make_flexible(flex, -1, true, {0.02});
  const Body each = Body::make_flexible(flex, -1, true, {0.01, 0.02, 0.03});
  // Modes of the body; the coordinates of this record are not modal.
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> motions(flex.modal_stiffness, flex.modal_mass);
  const MatrixXd Y = motions.eigenvectors();
  const MatrixXd D = Y.transpose() * uniform.D() * Y, D_each = Y.transpose() * each.D() * Y;
  for (int j = 0; j < 3; ++j) {
    const double critical = 2 * std::sqrt(motions.eigenvalues()[j]);
    EXPECT_NEAR(D(j, j), 0.02 * critical, 1e-13 * critical);
    EXPECT_NEAR(D_each(j, j), 0.01 * (j + 1) * critical, 1e-13 * critical);
  }
}

}  // namespace
}  // namespace bough::solver::testing
