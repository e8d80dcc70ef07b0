/// CSHEAR against closed forms: stiffness of rectangles and parallelograms, the tapered panel's inverse square, rods,
/// equilibrium, a web between flanges.
#include <functional>

#include <Eigen/Eigenvalues>

#include "element_checks.hpp"
#include "fe/elements/shear_panel.hpp"

namespace bough::fe::test {
namespace {

constexpr double kE = 3, kNu = 0.3, kG = 3 / 2.6, kT = 0.02;

SmallModel make_panel(const std::vector<Vector3d>& x, double f1 = 0, double f2 = 0) {
  SmallModel m;
  records::Mat1 material;
  material.id = 1, material.E = kE, material.nu = kNu, material.G = kG, material.rho = 0.8;
  m.deck.mat1.push_back(material);
  m.deck.pshear.push_back({1, 1, kT, 0.1, f1, f2, {}});
  for (const auto& p : x) {
    const int id = m.nodes.num_nodes() + 1;
    m.nodes.add_grid(id, p, make_rotation(static_cast<unsigned>(id)));
  }
  m.deck.shear_panels.push_back({1, 1, {1, 2, 3, 4}, {}});
  m.make();
  return m;
}

/// Twelve translations.
MatrixXd calc_translations(const SmallModel& m, const MatrixXd& K) {
  std::vector<int> rows;
  for (int i = 0; i < m.nodes.num_nodes(); ++i)
    for (int c = 0; c < 3; ++c) rows.push_back(6 * i + c);
  return pick(K, rows);
}

const std::vector<Vector3d> kRectangle = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
const std::vector<Vector3d> kGeneral = {{0, 0, 0}, {2, .2, 0}, {1.7, 1.4, 0}, {-.1, .9, 0}};
const std::vector<Vector3d> kWarped = {{0, 0, .05}, {2, .2, -.03}, {1.7, 1.4, .06}, {-.1, .9, -.04}};

TEST(ShearPanel, RigidMotionsGiveNoForceAndOneShearDoes) {
  for (const auto& x : {kRectangle, kGeneral, kWarped})
    for (double f : {0.0, 0.8}) {
      const SmallModel m = make_panel(x, f, f);
      const MatrixXd K = m.calc_stiffness();
      const double scale = K.cwiseAbs().maxCoeff();
      EXPECT_LT((K - K.transpose()).cwiseAbs().maxCoeff(), 1e-14 * scale);
      EXPECT_LT((K * m.nodes.calc_rigid_modes()).cwiseAbs().maxCoeff(), 1e-13 * scale);
      const VectorXd lambda = Eigen::SelfAdjointEigenSolver<MatrixXd>(K).eigenvalues();
      EXPECT_EQ((lambda.array() > 1e-12 * scale).count(), f > 0 ? 5 : 1);
      EXPECT_GE(lambda.minCoeff(), -1e-13 * scale);
    }
}

/// Simple shear γ: energy G t a b γ²/2, flow G t γ on every side.
TEST(ShearPanel, RectangleHasItsClosedForm) {
  const SmallModel m = make_panel(kRectangle);
  VectorXd u = VectorXd::Zero(24);
  const double shear = 1e-3;
  u[6 * 2] = u[6 * 3] = shear;  // the upper side moves along x by γ b
  EXPECT_NEAR(u.dot(m.calc_stiffness() * u), kG * kT * 2 * 1 * shear * shear, 1e-18);
  VectorXd s(8), u_e(12);
  for (int i = 0; i < 4; ++i) u_e.segment<3>(3 * i) = u.segment<3>(6 * i);
  m.elements[0]->stress_state()->calc_internal_forces(u_e, s);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(s[i], kG * kT * shear, 1e-17);
  EXPECT_EQ(s.tail(4).norm(), 0);
}

/// NASTRAN Theoretical Manual 5.3: flexibility A/(G t) (1 + 2 cot² α / (1 + ν)) per squared flow. The flow does work on
/// the shear of the sides alone: e = q · flexibility.
TEST(ShearPanel, ParallelogramHasTheManualsFlexibility) {
  for (double degrees : {90.0, 70.0, 45.0}) {
    const double a = degrees * M_PI / 180;
    const Vector3d side(2, 0, 0), other(std::cos(a), std::sin(a), 0);
    const SmallModel m = make_panel({Vector3d::Zero(), side, side + other, other});
    const MatrixXd K = calc_translations(m, m.calc_stiffness());
    // Forces of a unit flow: half of each side's at its ends.
    VectorXd f = VectorXd::Zero(12);
    const auto add = [&](int i, int j, const Vector3d& force) {
      f.segment<3>(3 * i) += force / 2;
      f.segment<3>(3 * j) += force / 2;
    };
    add(0, 1, -side), add(3, 2, side), add(1, 2, other), add(0, 3, -other);
    const double area = 2 * std::sin(a), cot = 1 / std::tan(a);
    const double flexibility = area / (kG * kT) * (1 + 2 * cot * cot / (1 + kNu));
    EXPECT_LT((K - f * f.transpose() / flexibility).norm(), 1e-12 * K.norm()) << degrees;
  }
}

/// A symmetric trapezoid: the flow on lines parallel to the bases goes with the inverse square of their width, the
/// sides' is the geometric mean of the bases'.
TEST(ShearPanel, FlowsOfATaperedPanelAreInEquilibrium) {
  for (const auto& x : {std::vector<Vector3d>{{-1, 0, 0}, {1, 0, 0}, {.5, 2, 0}, {-.5, 2, 0}}, kGeneral, kWarped}) {
    const SmallModel m = make_panel(x);
    const MatrixXd K = calc_translations(m, m.calc_stiffness());
    VectorXd u = VectorXd::Zero(12), s(8);
    u[6] = 1e-3, u[9] = 2e-3, u[1] = -1e-3;
    m.elements[0]->stress_state()->calc_internal_forces(u, s);
    EXPECT_NEAR(s[0] * s[2] / (s[1] * s[3]), 1, 1e-12);
    if (x[0].x() == -1) {
      EXPECT_NEAR(s[2] / s[0], 4, 1e-11);
      EXPECT_NEAR(s[1] / s[0], 2, 1e-11);
    }
    const VectorXd f = K * u;
    Vector3d force = Vector3d::Zero(), moment = force;
    for (int i = 0; i < 4; ++i) {
      force += f.segment<3>(3 * i);
      moment += x[static_cast<std::size_t>(i)].cross(Vector3d(f.segment<3>(3 * i)));
    }
    EXPECT_LT(force.norm() + moment.norm(), 1e-13 * f.norm());
    if (x[0].z() == 0) {
      // The corner forces are those of the flows: half of q L along each side.
      VectorXd by_flows = VectorXd::Zero(12);
      const double sense[] = {-1, 1, -1, 1};
      for (int i = 0; i < 4; ++i)
        for (int end : {i, (i + 1) % 4})
          by_flows.segment<3>(3 * end) +=
              0.5 * sense[i] * s[i] * (x[static_cast<std::size_t>((i + 1) % 4)] - x[static_cast<std::size_t>(i)]);
      const double sign = by_flows.dot(f) > 0 ? 1 : -1;
      EXPECT_LT((sign * by_flows - f).norm(), 1e-12 * f.norm());
      EXPECT_EQ(sign, 1);
    }
  }
}

/// F up to 1.01: F T A/(L12 + L34); above: F T²/2.
TEST(ShearPanel, RodsAlongTheSides) {
  for (double f : {0.0, 0.5, 1.0, 30.0}) {
    const SmallModel m = make_panel(kRectangle, f, 0);
    VectorXd u = VectorXd::Zero(24);
    u[6] = u[12] = 1e-3;                                      // stretched along x: no shear
    const double area = f > 1.01 ? f * kT * kT : f * kT * 1;  // both rods together; F1 = 1: the whole width
    EXPECT_NEAR(u.dot(m.calc_stiffness() * u), kE * area / 2 * 1e-6, 1e-18) << f;
  }
}

TEST(ShearPanel, MassIsThatOfTheAreaAtItsCentre) {
  const SmallModel m = make_panel(kGeneral);
  const MatrixXd rigid =
      m.nodes.calc_rigid_modes().transpose() * m.calc_mass(MassKind::Lumped) * m.nodes.calc_rigid_modes();
  // Two triangles.
  const auto part = [](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    return std::pair(0.5 * (b - a).cross(c - a).norm(), Vector3d((a + b + c) / 3));
  };
  const auto [A1, c1] = part(kGeneral[0], kGeneral[1], kGeneral[2]);
  const auto [A2, c2] = part(kGeneral[0], kGeneral[2], kGeneral[3]);
  const double mass = (0.8 * kT + 0.1) * (A1 + A2);
  EXPECT_NEAR(rigid(0, 0), mass, 1e-14);
  const Vector3d centre = (A1 * c1 + A2 * c2) / (A1 + A2);
  EXPECT_NEAR(rigid(1, 5), mass * centre.x(), 1e-14);
  EXPECT_NEAR(rigid(0, 5), -mass * centre.y(), 1e-14);
}

TEST(ShearPanel, GeometricStiffnessTurnsTheForces) {
  for (const auto& x : {kRectangle, std::vector<Vector3d>{{0, 0, 0}, {2, 0, 0}, {2.5, 1, 0}, {.5, 1, 0}}}) {
    const SmallModel m = make_panel(x, 0.7, 0.4);
    VectorXd u(24);
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (double& value : u) value = normal(random);
    const MatrixXd K_G = m.calc_geometric_stiffness(u), Phi_R = m.nodes.calc_rigid_modes();
    const VectorXd f = m.calc_stiffness() * u;
    EXPECT_LT((K_G - K_G.transpose()).norm(), 1e-14 * K_G.norm());
    EXPECT_LT((K_G * Phi_R.leftCols<3>()).norm(), 1e-13 * K_G.norm());
    EXPECT_LT((m.calc_geometric_stiffness(-2 * u) + 2 * K_G).norm(), 1e-13 * K_G.norm());
    for (int axis = 0; axis < 3; ++axis) {
      VectorXd expected = VectorXd::Zero(24);
      for (int i = 0; i < 24; i += 6) expected.segment<3>(i) = Vector3d::Unit(axis).cross(f.segment<3>(i));
      EXPECT_LT((K_G * Phi_R.col(3 + axis) - expected).norm(), 1e-12 * f.norm());
    }
    expect_third_derivative_of_geometric(m);
  }
}

/// Three bays of web (a x h) between flanges and stiffeners under a tip shear P: flow P/h in every web, flange forces
/// linear; δ = P n a/(G t h) + Σ ∫N²/(EA) by hand (rods of constant force per bay: the mean of its ends').
TEST(ShearPanel, CantileverOfWebsAndRods) {
  const int n = 3;
  const double a = 0.5, h = 0.4, A = 0.01;
  SmallModel m;
  records::Mat1 material;
  material.id = 1, material.E = kE, material.nu = kNu, material.G = kG;
  m.deck.mat1.push_back(material);
  m.deck.pshear.push_back({1, 1, kT, 0, 0, 0, {}});
  records::Prod rod;
  rod.id = 2, rod.mid = 1, rod.A = A;
  m.deck.prod.push_back(rod);
  for (int i = 0; i <= n; ++i) {
    m.nodes.add_grid(2 * i + 1, {i * a, 0, 0});
    m.nodes.add_grid(2 * i + 2, {i * a, h, 0});
  }
  int id = 0;
  const auto add_rod = [&](int ga, int gb) {
    records::Crod e;
    e.id = ++id, e.pid = 2, e.ga = ga, e.gb = gb;
    m.deck.crod.push_back(e);
  };
  for (int i = 0; i < n; ++i) {
    m.deck.shear_panels.push_back({100 + i, 1, {2 * i + 1, 2 * i + 3, 2 * i + 4, 2 * i + 2}, {}});
    add_rod(2 * i + 1, 2 * i + 3);
    add_rod(2 * i + 2, 2 * i + 4);
    add_rod(2 * i + 3, 2 * i + 4);
  }
  m.make();
  std::vector<int> fixed;
  for (int i = 0; i < m.nodes.num_gdofs(); ++i)
    if (i < 12 || i % 6 > 1) fixed.push_back(i);
  VectorXd f = VectorXd::Zero(m.nodes.num_gdofs());
  const double P = 1;
  f[6 * (2 * n) + 1] = f[6 * (2 * n + 1) + 1] = P / 2;
  const VectorXd u = solve_static(m.calc_stiffness(), f, fixed);
  double by_hand = P * n * a / (kG * kT * h);
  for (int i = 0; i < n; ++i) {
    const double N = P * (n - i - 0.5) * a / h;
    by_hand += 2 * N * N * a / (kE * A) / P;
  }
  EXPECT_NEAR(f.dot(u) / by_hand, 1, 1e-12);
}

TEST(ShearPanel, BadCardsAreReported) {
  const auto say = [](const std::function<void(SmallModel&)>& spoil) {
    SmallModel m;
    records::Mat1 material;
    material.id = 1, material.E = kE, material.nu = kNu, material.G = kG;
    m.deck.mat1.push_back(material);
    m.deck.pshear.push_back({1, 1, kT, 0, 0, 0, {}});
    for (int i = 0; i < 4; ++i) m.nodes.add_grid(i + 1, kRectangle[static_cast<std::size_t>(i)]);
    m.deck.shear_panels.push_back({1, 1, {1, 2, 3, 4}, {}});
    spoil(m);
    Diagnostics diagnostics;
    make_elements(m.deck, m.nodes, diagnostics);
    std::string ids;
    for (const auto& d : diagnostics.items()) ids += d.id + " ";
    return ids;
  };
  EXPECT_EQ(say([](SmallModel&) {}), "");
  EXPECT_EQ(say([](SmallModel& m) { m.deck.shear_panels[0].pid = 9; }), "fe.missing-property ");
  EXPECT_EQ(say([](SmallModel& m) { m.deck.shear_panels[0].grids = {1, 3, 2, 4}; }), "fe.bad-facet ");
  EXPECT_EQ(say([](SmallModel& m) { m.deck.pshear[0].t = 0; }), "fe.bad-property ");
  EXPECT_EQ(say([](SmallModel& m) { m.deck.pshear[0].mid = 9; }), "fe.missing-material ");
  EXPECT_EQ(say([](SmallModel& m) { m.deck.shear_panels[0].grids[2] = 9; }), "fe.missing-grid ");
}

}  // namespace
}  // namespace bough::fe::test
