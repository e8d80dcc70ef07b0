/// Strain energy of elements in frames that follow their nodes: against the same energy at finite displacements in long
/// double, against tests/oracle/third_order, and against a circle.
#include "fe/corotational/corotational_element.hpp"

#include <numeric>

#include <Eigen/Eigenvalues>

#include "element_checks.hpp"
#include "fe/corotational/energy_derivatives.hpp"
#include "fe/corotational/series.hpp"

namespace bough::fe::test {
namespace {

using Real = long double;
using RealVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using Real3 = Eigen::Matrix<Real, 3, 1>;
using Real33 = Eigen::Matrix<Real, 3, 3>;

std::vector<Node> list_nodes(const SmallModel& m) {
  std::vector<Node> nodes;
  for (int k = 0; k < m.nodes.num_nodes(); ++k) nodes.push_back(m.nodes.node(k));
  return nodes;
}

Real33 rotate(const Real3& theta) {
  const Real t = theta.norm();
  if (t == 0) return Real33::Identity();
  return Eigen::AngleAxis<Real>(t, theta / t).toRotationMatrix();
}

Real3 find_vector(const Real33& R) {
  const Real3 axis(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  const Real s = axis.norm() / 2;
  return s == 0 ? Real3(axis / 2) : Real3(axis / (2 * s) * std::atan2(s, (R.trace() - 1) / 2));
}

/// V at finite u: the frame by Newton, rotations by their closed forms.
Real calc_energy(const CorotationalElement& e, const RealVector& u) {
  const Eigen::Index n = e.arms().cols();
  const Eigen::Matrix<Real, 3, Eigen::Dynamic> arms = e.arms().cast<Real>();
  Eigen::Matrix<Real, 3, Eigen::Dynamic> x = arms;
  Real33 B = Real33::Zero();
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto row = static_cast<std::size_t>(k);
    x.col(k) += u.segment<3>(e.translations()[row]);
    if (e.rotations()[row] >= 0) B += Real(e.rotation_weight()) * rotate(u.segment<3>(e.rotations()[row]));
  }
  x.colwise() -= x.rowwise().mean().eval();
  B += x * arms.transpose();
  Real33 R = Real33::Identity();
  for (int step = 0; step < 50; ++step) {
    const Real33 H = R.transpose() * B;
    const Real3 axis(H(2, 1) - H(1, 2), H(0, 2) - H(2, 0), H(1, 0) - H(0, 1));
    const Real33 A = H.trace() * Real33::Identity() - (H + H.transpose()) / 2;
    R = R * rotate(A.ldlt().solve(axis));
  }
  RealVector d(u.size());
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto row = static_cast<std::size_t>(k);
    d.segment<3>(e.translations()[row]) = R.transpose() * x.col(k) - arms.col(k);
    if (e.rotations()[row] >= 0)
      d.segment<3>(e.rotations()[row]) = find_vector(R.transpose() * rotate(u.segment<3>(e.rotations()[row])));
  }
  Real V = d.dot(e.K().cast<Real>() * d) / 2;
  if (e.P().empty()) return V;
  RealVector w(static_cast<Eigen::Index>(e.P().size()));
  for (Eigen::Index m = 0; m < w.size(); ++m) w[m] = d.dot(e.P()[static_cast<std::size_t>(m)].cast<Real>() * d);
  return V + (e.F().cast<Real>() * d).dot(w) / 2 + w.dot(e.E().cast<Real>() * w) / 8;
}

/// Coefficients 2 to 5 of V(ε x) by interpolation at 2 n points.
std::array<Real, 4> interpolate_energy(const CorotationalElement& e, const VectorXd& x, Real h) {
  constexpr int n = 14;
  Eigen::Matrix<Real, n, n> powers;
  Eigen::Matrix<Real, n, 1> V;
  for (int i = 0; i < n; ++i) {
    const int j = i < n / 2 ? i - n / 2 : i - n / 2 + 1;
    V[i] = calc_energy(e, Real(j) * h * x.cast<Real>()) / (h * h);
    for (int k = 0; k < n; ++k) powers(i, k) = std::pow(Real(j), k + 1);
  }
  const Eigen::Matrix<Real, n, 1> c = powers.fullPivLu().solve(V);
  return {c[1], c[2] / h, c[3] / (h * h), c[4] / (h * h * h)};
}

MatrixXd make_curve(const VectorXd& x) {
  MatrixXd u = MatrixXd::Zero(x.size(), kSeriesTop);
  u.col(0) = x;
  return u;
}

/// One of each kind, distorted, in a random orientation.
SmallModel make_mixed_model() {
  SmallModel m;
  const Matrix3d R = make_rotation(5);
  const std::vector<Vector3d> x = {{0, 0, 0},   {1.2, .1, .02}, {1.1, .9, -.03}, {-.1, 1.1, .04},
                                   {.1, 0, .9}, {1.1, .2, 1},   {1, 1, 1.2},     {0, .9, 1.1}};
  for (std::size_t k = 0; k < x.size(); ++k) m.nodes.add_grid(static_cast<int>(k) + 1, R * x[k]);
  records::Mat1 material;
  material.id = 1, material.E = 3, material.nu = 0.3, material.G = 3 / 2.6, material.rho = 0.8;
  m.deck.mat1.push_back(material);
  records::Pshell shell;
  shell.id = 1, shell.mid1 = shell.mid2 = shell.mid3 = 1, shell.t = 0.2;
  m.deck.pshell.push_back(shell);
  m.deck.psolid.push_back({2, 1, 0, {}});
  records::Pbar bar;
  bar.id = 3, bar.mid = 1, bar.A = 0.5, bar.I1 = 0.04, bar.I2 = 0.07, bar.J = 0.05, bar.k1 = 0.8, bar.k2 = 0.6;
  m.deck.pbar.push_back(bar);
  m.deck.prod.push_back({4, 1, 0.4, 0.02, 0, 0.1, {}});
  records::BeamElement beam;
  beam.id = 1, beam.pid = 3, beam.ga = 1, beam.gb = 2, beam.v = Vector3d(0.2, 1, -0.3);
  beam.wa = Vector3d(0.1, 0.2, 0), beam.wb = Vector3d(0, 0.1, -0.2);
  m.deck.beams.push_back(beam);
  m.deck.crod.push_back({2, 4, 3, 6, {}});
  records::ShellElement quad;
  quad.id = 3, quad.pid = 1, quad.card = "CQUAD4", quad.grids = {1, 2, 3, 4}, quad.z_offset = 0.1;
  m.deck.shells.push_back(quad);
  quad.id = 4, quad.card = "CTRIA3", quad.grids = {5, 6, 7};
  m.deck.shells.push_back(quad);
  records::SolidElement solid;
  solid.id = 5, solid.pid = 2, solid.card = "CHEXA", solid.corners = {1, 2, 3, 4, 5, 6, 7, 8};
  m.deck.solids.push_back(solid);
  m.make();
  return m;
}

TEST(Corotational, ForcesAreThoseOfTheEnergyAtFiniteDisplacements) {
  const SmallModel m = make_mixed_model();
  const auto nodes = list_nodes(m);
  ASSERT_EQ(m.elements.size(), 5u);
  for (const auto& element : m.elements) {
    const CorotationalElement e(*element, nodes);
    ASSERT_TRUE(e.follows_nodes()) << element->card();
    const VectorXd x = 0.3 * make_random(31, e.num_dofs());
    const MatrixXd f = e.calc_forces(make_curve(x));
    const auto V = interpolate_energy(e, x, Real(0.02));
    const double scale = std::abs(static_cast<double>(V[0])) + std::abs(static_cast<double>(V[2]));
    for (int k = 1; k <= 4; ++k)
      EXPECT_NEAR(f.col(k - 1).dot(x) / (k + 1), static_cast<double>(V[static_cast<std::size_t>(k - 1)]), 1e-8 * scale)
          << element->card() << " order " << k + 1;
  }
}

/// Series that end earlier have the orders below, for curves in any block.
TEST(Corotational, ForcesOfFewerOrdersAreTheSame) {
  const SmallModel m = make_mixed_model();
  const auto nodes = list_nodes(m);
  constexpr int num_curves = 19;
  for (const auto& element : m.elements) {
    const CorotationalElement e(*element, nodes);
    const MatrixXd u =
        0.2 * make_random(7, e.num_dofs() * kSeriesTop * num_curves).reshaped(e.num_dofs(), kSeriesTop * num_curves);
    const MatrixXd f = e.calc_forces(u);
    for (int top = 2; top < kSeriesTop; ++top) {
      std::vector<int> kept;
      for (int c = 0; c < num_curves; ++c)
        for (int k = 0; k < top; ++k) kept.push_back(kSeriesTop * c + k);
      EXPECT_LT((e.calc_forces(u(Eigen::all, kept), top) - f(Eigen::all, kept)).norm(), 1e-13 * f.norm())
          << element->card() << " to order " << top;
    }
  }
}

/// V⁗(a, b, c, ·) d = V⁗(d, b, c, ·) a: the forces are a gradient in every direction, not along their curve alone.
TEST(Corotational, FourthDerivativeIsSymmetric) {
  const SmallModel m = make_mixed_model();
  const auto nodes = list_nodes(m);
  const int n = m.nodes.num_gdofs();
  MatrixXd a = make_random(1, n), b = make_random(2, n), c = make_random(3, n), d = make_random(4, n);
  MatrixXd A(n, 2), B(n, 2), C(n, 2);
  A << a, d;
  B << b, b;
  C << c, c;
  const MatrixXd fourth = calc_fourth_derivative(m.elements, nodes, A, B, C);
  EXPECT_NEAR(fourth.col(0).dot(d.col(0)), fourth.col(1).dot(a.col(0)), 1e-10 * fourth.norm() * a.norm());
}

TEST(Corotational, FiniteRigidMotionsGiveNoForce) {
  const SmallModel m = make_mixed_model();
  const auto nodes = list_nodes(m);
  SeriesVector theta = make_zero_vector();
  theta[1] = Vector3d(0.7, -0.4, 1.1), theta[2] = Vector3d(-0.2, 0.5, 0.3), theta[4] = Vector3d(1, 2, 3);
  const SeriesMatrix R = calc_exponential(theta);
  MatrixXd u(m.nodes.num_gdofs(), kSeriesTop);
  for (const Node& node : nodes)
    for (int k = 1; k <= kSeriesTop; ++k) {
      u.block<3, 1>(node.first_gdof, k - 1) = R[static_cast<std::size_t>(k)] * node.x + Vector3d(k, 1, -2);
      u.block<3, 1>(node.first_gdof + 3, k - 1) = theta[static_cast<std::size_t>(k)];
    }
  EXPECT_LT(calc_force_series(m.elements, nodes, u).norm(), 1e-10 * m.calc_stiffness().norm());
}

/// Energies along ε x of one Euler-Bernoulli bar: tests/oracle/third_order/corotational.py.
TEST(Corotational, IsThatOfTheOracle) {
  SmallModel m;
  m.nodes.add_grid(1, Vector3d::Zero());
  m.nodes.add_grid(2, Vector3d(1, 0.5, 0.2));
  records::Mat1 material;
  material.id = 1, material.E = 1, material.G = 1;
  m.deck.mat1.push_back(material);
  records::Pbar bar;
  bar.id = 1, bar.mid = 1, bar.A = 5, bar.I1 = 1.9, bar.I2 = 1.1, bar.J = 0.7;
  m.deck.pbar.push_back(bar);
  records::BeamElement beam;
  beam.id = 1, beam.pid = 1, beam.ga = 1, beam.gb = 2, beam.v = Vector3d(0, 1, 0);
  m.deck.beams.push_back(beam);
  m.make();
  const CorotationalElement e(*m.elements[0], list_nodes(m));
  VectorXd a(12), b(12);
  for (int i = 0; i < 12; ++i) a[i] = 0.1 * std::sin(1.7 * (i + 1)), b[i] = 0.1 * std::cos(2.3 * (i + 1));
  const double expected[2][4] = {
      {0.38174219128129255, 0.03382500607263935, -0.00196706530281576, -0.0015264111023415646},
      {0.7389145532955487, 0.056420144193296835, -0.013364360780837642, -0.0039010187918288113}};
  for (int i = 0; i < 2; ++i) {
    const VectorXd x = i == 0 ? a : VectorXd(a + b);
    const MatrixXd f = e.calc_forces(make_curve(x));
    for (int k = 1; k <= 4; ++k) EXPECT_NEAR(f.col(k - 1).dot(x) / (k + 1), expected[i][k - 1], 1e-12) << i << k;
  }
}

/// An end moment turns the tip by η and bends a circle: tip at sin η/η and (1 - cos η)/η lengths, V = ½ EI η²/L. Static
/// manifold by hand: K u2 = -V‴(φ, φ, ·)/2 and so on, φ_tip held.
TEST(Corotational, EndMomentBendsACircle) {
  records::Pbar section;
  section.A = 1e5, section.I1 = section.I2 = 1, section.J = 1;
  const int num = 8, n = 6 * num + 6, tip = 6 * num;
  const SmallModel m = make_bar_chain({.num_elements = num, .section = section});
  const auto nodes = list_nodes(m);
  std::vector<int> fixed = {0, 1, 2, 3, 4, 5};
  const MatrixXd K = m.calc_stiffness();
  VectorXd f = VectorXd::Zero(n);
  f[tip + 5] = 1;
  MatrixXd u = MatrixXd::Zero(n, kSeriesTop);
  u.col(0) = solve_static(K, f, fixed);
  u.col(0) /= u(tip + 5, 0);
  fixed.push_back(tip + 5);
  for (int k = 2; k <= 4; ++k)
    u.col(k - 1) = solve_static(K, -calc_force_series(m.elements, nodes, u).col(k - 1), fixed);
  EXPECT_NEAR(u(tip + 1, 0), 1.0 / 2, 1e-9);
  EXPECT_NEAR(u(tip, 1), -1.0 / 6, 1e-9);
  EXPECT_NEAR(u(tip + 1, 2), -1.0 / 24, 1e-8);
  EXPECT_NEAR(u(tip, 3), 1.0 / 120, 3e-5 / 120);
  const MatrixXd forces = calc_force_series(m.elements, nodes, u);
  EXPECT_NEAR(forces(tip + 5, 0), 1, 1e-9);
  EXPECT_NEAR(forces.row(tip + 5).segment<3>(1).norm(), 0, 1e-6);
}

/// A strip of flat shells along x, bent to a circle about y. K_G of shells has moments work on Green's curvature, per
/// length before the strain: that shortens the strip by t²/12 (EI κ²/EA) more.
TEST(Corotational, EndMomentBendsAStripOfShellsToACircle) {
  for (const char* card : {"CQUAD4", "CQUADR"}) {
    SmallModel m;
    records::Mat1 material;
    material.id = 1, material.E = 1e6, material.G = 5e5;
    m.deck.mat1.push_back(material);
    records::Pshell shell;
    shell.id = 1, shell.mid1 = shell.mid2 = 1, shell.t = 0.01;
    m.deck.pshell.push_back(shell);
    const int num = 8;
    for (int i = 0; i <= num; ++i)
      for (int side = 0; side < 2; ++side) m.nodes.add_grid(2 * i + side + 1, Vector3d(double(i) / num, 0.1 * side, 0));
    for (int i = 0; i < num; ++i) {
      records::ShellElement e;
      e.id = i + 1, e.pid = 1, e.card = card, e.grids = {2 * i + 1, 2 * i + 3, 2 * i + 4, 2 * i + 2};
      m.deck.shells.push_back(e);
    }
    m.make();
    const auto nodes = list_nodes(m);
    const int n = m.nodes.num_gdofs(), tip = 12 * num;
    std::vector<int> fixed(12);
    std::iota(fixed.begin(), fixed.end(), 0);
    const MatrixXd K = m.calc_stiffness();
    VectorXd f = VectorXd::Zero(n);
    f[tip + 4] = f[tip + 10] = 0.5;
    MatrixXd u = MatrixXd::Zero(n, kSeriesTop);
    u.col(0) = solve_static(K, f, fixed);
    u.col(0) /= u(tip + 4, 0);
    fixed.push_back(tip + 4);
    fixed.push_back(tip + 10);
    for (int k = 2; k <= 4; ++k)
      u.col(k - 1) = solve_static(K, -calc_force_series(m.elements, nodes, u).col(k - 1), fixed);
    EXPECT_NEAR(u(tip + 2, 0), -1.0 / 2, 1e-9) << card;
    EXPECT_NEAR(u(tip, 1), -1.0 / 6 - 1e-4 / 12, 1e-6) << card;
    EXPECT_NEAR(u(tip + 2, 2), 1.0 / 24, 1e-5) << card;
    EXPECT_NEAR(u(tip, 3), 1.0 / 120, 1e-5) << card;
  }
}

TEST(Corotational, ScalarSpringsStayLinear) {
  SmallModel m;
  m.nodes.add_grid(1, Vector3d::Zero());
  m.nodes.add_grid(2, Vector3d(1, 0, 0));
  records::ScalarSpring spring;
  spring.id = 1, spring.k = 7, spring.g1 = 1, spring.c1 = 1, spring.g2 = 2, spring.c2 = 1;
  m.deck.springs.push_back(spring);
  m.make();
  const CorotationalElement e(*m.elements[0], list_nodes(m));
  EXPECT_FALSE(e.follows_nodes());
  const MatrixXd u = make_random(1, kSeriesTop * e.num_dofs()).reshaped(e.num_dofs(), kSeriesTop);
  EXPECT_EQ(e.calc_forces(u), e.K() * u);
}

}  // namespace
}  // namespace bough::fe::test
