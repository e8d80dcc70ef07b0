// Bodies of third order against clouds of points that are moved by polynomials: all displacements are exact.
#include "solver/bodies/third_order.hpp"

#include <gtest/gtest.h>

#include "solver/bodies/marker.hpp"
#include "tests/solver/bodies/hamel.hpp"
#include "tests/solver/bodies/marker_rates.hpp"

namespace bough::solver::testing {
namespace {

using records::ThirdOrder;

constexpr int kNumModes = 4, kNumFields = 3;

/// Value of a packed polynomial by its exponents.
VectorXd calc_packed(const MatrixXd& c, const VectorXd& x, int degree) {
  const Eigen::MatrixXi e = records::list_exponents(static_cast<int>(x.size()), degree);
  VectorXd sum = VectorXd::Zero(c.cols());
  for (Eigen::Index i = 0; i < e.rows(); ++i) {
    double monomial = 1;
    for (Eigen::Index j = 0; j < x.size(); ++j) monomial *= std::pow(x[j], e(i, j));
    sum += monomial * c.row(i).transpose();
  }
  return sum;
}

/// Large amplitudes of a body: modes, or combinations of all modes.
struct Large {
  std::vector<int> modes;
  int num_directions = 0;
};
void PrintTo(const Large& large, std::ostream* out) {
  *out << (large.num_directions > 0 ? "directions " : "modes ");
  for (const int mode : large.modes) *out << mode;
  if (large.num_directions > 0) *out << large.num_directions;
}

class ThirdOrderTest : public ::testing::TestWithParam<Large> {
 protected:
  ThirdOrderTest() : points_(make_point_body(kNumModes + kNumFields, 31, 0)) {
    make_orthonormal();
    both_ = points_.make_record("p");
    PointBody alone = points_;
    alone.num_modes = kNumModes;
    for (auto* list : {&alone.phi, &alone.psi})
      for (auto& shape : *list) shape = MatrixXd(shape.leftCols(kNumModes));
    for (auto* list : {&alone.g, &alone.g_theta})
      for (auto& node : *list)
        for (auto& g : node) g = MatrixXd::Zero(kNumModes, kNumModes);
    alone.K = points_.K.topLeftCorner(kNumModes, kNumModes);
    alone.D = points_.D.topLeftCorner(kNumModes, kNumModes);
    flex_ = alone.make_record("p");
    set_third_order();
    Random random(8);
    eta_ = random.vector_n(kNumModes, 0.4);
    V_ = random.vector_n(6 + kNumModes);
  }

  /// The last modes become fields: orthonormal under the mass, and to the first ones.
  void make_orthonormal() {
    const MatrixXd M = points_.make_record("p").modal_mass;
    const MatrixXd along = M.topLeftCorner(kNumModes, kNumModes).ldlt().solve(M.topRightCorner(kNumModes, kNumFields));
    const MatrixXd rest =
        M.bottomRightCorner(kNumFields, kNumFields) - M.bottomLeftCorner(kNumFields, kNumModes) * along;
    const MatrixXd S = MatrixXd(rest.llt().matrixL()).transpose().inverse();
    for (auto* list : {&points_.phi, &points_.psi})
      for (auto& shape : *list) {
        const MatrixXd first = shape.leftCols(kNumModes), last = shape.rightCols(kNumFields);
        shape.rightCols(kNumFields) = (last - first * along) * S;
      }
  }

  void set_third_order() {
    Random random(17);
    ThirdOrder& third = flex_.third_order;
    third.large = GetParam().modes;
    if (const int num = GetParam().num_directions; num > 0) {
      third.directions = MatrixXd::NullaryExpr(num, kNumModes, [&] { return random(0.7); });
      third.count_directions();
    }
    const int N = third.num_large();
    const auto fill = [&](int n, int degree, int columns, double scale) {
      return MatrixXd(
          MatrixXd::NullaryExpr(records::count_monomials(n, degree), columns, [&] { return random(scale); }));
    };
    for (int k = 3; k <= 6; ++k) third.energy[static_cast<size_t>(k - 3)] = fill(N, k, 1, 0.5);
    third.energy_small = fill(N, 2, kNumModes - N, third.directions.size() > 0 ? 0 : 0.5);
    flex_.interface_nodes = {101, 103};
    third.node.resize(2);
    const auto ne = static_cast<int>(flex_.locators.size());
    for (int k = 2; k <= 4; ++k) {
      const auto at = static_cast<size_t>(k - 2);
      const int n = third.num_variables(k, kNumModes);
      third.amplitudes[at] = fill(n, k, kNumFields, 0.4);
      third.load[at] = fill(n, k, ne, 0.4);
      for (auto& node : third.node) node[at] = fill(n, k, 6, 0.4);
    }
    for (const auto& phi : both_.phi) third.fields.push_back(phi.rightCols(kNumFields));
    third.integrals = both_.integrals();
  }

  VectorXd get_large(const VectorXd& eta) const {
    const ThirdOrder& third = flex_.third_order;
    return third.directions.size() > 0 ? VectorXd(third.directions * eta) : VectorXd(eta(third.large));
  }
  VectorXd get_variables(int degree, const VectorXd& eta) const { return degree == 2 ? eta : get_large(eta); }
  VectorXd calc_xi(const VectorXd& eta) const {
    VectorXd xi(kNumModes + kNumFields);
    xi << eta, VectorXd::Zero(kNumFields);
    for (int k = 2; k <= 4; ++k)
      xi.tail(kNumFields) +=
          calc_packed(flex_.third_order.amplitudes[static_cast<size_t>(k - 2)], get_variables(k, eta), k);
    return xi;
  }
  double calc_energy(const VectorXd& eta) const {
    const ThirdOrder& third = flex_.third_order;
    const VectorXd x = get_large(eta);
    double V = 0.5 * eta.dot(flex_.modal_stiffness * eta);
    for (int k = 3; k <= 6; ++k) V += calc_packed(third.energy[static_cast<size_t>(k - 3)], x, k)[0];
    if (third.directions.size() > 0) return V;
    const VectorXd on_small = calc_packed(third.energy_small, x, 2);
    for (int j = 0, s = 0; j < kNumModes; ++j)
      if (!std::count(third.large.begin(), third.large.end(), j)) V += eta[j] * on_small[s++];
    return V;
  }

  PointBody points_;
  records::FlexBody both_, flex_;
  VectorXd eta_, V_;
};

TEST_P(ThirdOrderTest, KineticEnergyIsThatOfThePoints) {
  const Body body = Body::make_flexible(flex_, -1, true, {});
  BodyInertia x = body.make_inertia();
  body.calc_inertia(V_.segment<3>(3), eta_, V_.tail(kNumModes), x);
  const double h = 1e-3;
  const VectorXd rate = V_.tail(kNumModes);
  const auto at = [&](double t) { return calc_xi(eta_ + t * rate); };
  const VectorXd xi_dot = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
  const double exact = points_.calc_kinetic(V_.head<3>(), V_.segment<3>(3), at(0), xi_dot);
  EXPECT_NEAR(0.5 * V_.dot(x.make_M() * V_), exact, 1e-9 * exact);
  EXPECT_NEAR(body.calc_strain_energy(eta_), calc_energy(eta_), 1e-12);
}

// Hamel's equations by differences of T and V, as of bodies of second order (body_test.cpp).
TEST_P(ThirdOrderTest, EquationsOfMotionFollowFromTheEnergies) {
  const Body body = Body::make_flexible(flex_, -1, true, {});
  const VectorXd V_dot = Random(5).vector_n(6 + kNumModes);
  const auto calc_momentum = [&](const VectorXd& V, const VectorXd& eta) {
    BodyInertia x = body.make_inertia();
    body.calc_inertia(V.segment<3>(3), eta, V.tail(kNumModes), x);
    return VectorXd(x.make_M() * V);
  };
  const auto calc_kinetic = [&](const VectorXd& eta) { return 0.5 * V_.dot(calc_momentum(V_, eta)); };
  const VectorXd eta_dot = V_.tail(kNumModes), eta_ddot = V_dot.tail(kNumModes);
  const auto at = [&](double t) { return calc_momentum(V_ + t * V_dot, eta_ + t * eta_dot + 0.5 * t * t * eta_ddot); };
  const double h = 1e-4;
  VectorXd expected = calc_hamel_rates(V_, at, h);
  const Vector3d v = V_.head<3>(), w = V_.segment<3>(3);
  for (int j = 0; j < kNumModes; ++j) {
    const auto calc_lagrangian = [&](double s) {
      const VectorXd moved = eta_ + s * VectorXd::Unit(kNumModes, j);
      return calc_kinetic(moved) - calc_energy(moved);
    };
    expected[6 + j] -=
        (8 * (calc_lagrangian(1e-3) - calc_lagrangian(-1e-3)) - (calc_lagrangian(2e-3) - calc_lagrangian(-2e-3))) /
        12e-3;
  }
  expected.tail(kNumModes) += flex_.modal_damping * eta_dot;
  BodyInertia x = body.make_inertia();
  body.calc_inertia(w, eta_, eta_dot, x);
  VectorXd acceleration = V_dot;
  acceleration.head<3>() += w.cross(v);
  const VectorXd actual = x.make_M() * acceleration + x.h;
  EXPECT_LT((actual - expected).norm(), 1e-8 * expected.norm());
}

TEST_P(ThirdOrderTest, NodesMoveByTheirPolynomials) {
  const Body body = Body::make_flexible(flex_, -1, true, {});
  const VectorXd eta_dot = V_.tail(kNumModes);
  for (const int id : {103, 102}) {  // in the interface, and not
    const Node& node = body.nodes()[static_cast<size_t>(body.find_node(id))];
    NodeInBody k;
    calc_node_in_body(node, eta_, eta_dot, k);
    const auto at = static_cast<size_t>(id - 101);
    Vector6d expected;
    if (id == 103) {
      expected = flex_.phi[at] * eta_;
      for (int d = 2; d <= 4; ++d)
        expected += calc_packed(flex_.third_order.node[1][static_cast<size_t>(d - 2)], get_variables(d, eta_), d);
    } else {
      expected = both_.phi[at] * calc_xi(eta_);
    }
    EXPECT_LT((k.r - node.p - expected.head<3>()).norm(), 1e-13);
    EXPECT_LT((k.theta - expected.tail<3>()).norm(), 1e-13);
  }
}

TEST_P(ThirdOrderTest, MarkersAndWrenchesFollowTheRates) {
  const Body body = Body::make_flexible(flex_, -1, true, {});
  Random random(21);
  for (const int id : {101, 104}) {
    const Marker marker{0, body.find_node(id), random.vector(), random.rotation(), true};
    const VectorXd eta_dot = random.vector_n(kNumModes), eta_ddot = random.vector_n(kNumModes);
    const MarkerMotion m = expect_marker_rates(body, marker, eta_, eta_dot, eta_ddot, 1e-6);
    const Vector3d f = random.vector(), t = random.vector();
    NodeInBody k;
    const Node& node = body.nodes()[static_cast<size_t>(marker.node)];
    calc_node_in_body(node, eta_, eta_dot, k);
    VectorXd Q = VectorXd::Zero(kNumModes);
    add_node_generalized_force(node, eta_, k.T, f, t, Q);
    EXPECT_NEAR(Q.dot(eta_dot), f.dot(k.v) + t.dot(k.w), 1e-12);
    Vector3d a = k.gamma_t, alpha = k.gamma_r;
    add_node_acceleration(node, eta_, eta_ddot, k.T, a, alpha);
    Marker plain{0, marker.node, Vector3d::Zero(), Matrix3d::Identity(), true};
    MarkerMotion at_node = make_marker_motion(body, plain);
    calc_marker_position(body, plain, eta_, at_node);
    calc_marker_velocity(body, plain, eta_, eta_dot, at_node);
    EXPECT_LT((at_node.J.topRows<3>() * eta_ddot + at_node.gamma_v - a).norm(), 1e-12);
    EXPECT_LT((at_node.J.bottomRows<3>() * eta_ddot + at_node.gamma_w - alpha).norm(), 1e-12);
  }
}

TEST_P(ThirdOrderTest, WorkOfALoadIsItsPolynomial) {
  const ThirdOrderBody third(flex_);
  const Potential load = third.make_load(flex_, 2);
  const auto calc = [&](const VectorXd& eta) {
    double value = 0;
    for (int k = 2; k <= 4; ++k)
      value += calc_packed(flex_.third_order.load[static_cast<size_t>(k - 2)].col(2), get_variables(k, eta), k)[0];
    return value;
  };
  VectorXd gradient(kNumModes);
  EXPECT_NEAR(load.calc(eta_, gradient.data()), calc(eta_), 1e-13);
  for (int j = 0; j < kNumModes; ++j) {
    const VectorXd step = 1e-4 * VectorXd::Unit(kNumModes, j);
    EXPECT_NEAR(gradient[j], (calc(eta_ + step) - calc(eta_ - step)) / 2e-4, 1e-7);
  }
}

INSTANTIATE_TEST_SUITE_P(LargeModes, ThirdOrderTest,
                         ::testing::Values(Large{{0, 1, 2, 3}}, Large{{0, 2}}, Large{{3}}, Large{{}, 3}, Large{{}, 1}));

}  // namespace
}  // namespace bough::solver::testing
