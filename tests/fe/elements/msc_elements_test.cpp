/// GENEL, CGAP and PBCOMP against elements and closed forms that are the same thing written otherwise.
#include <Eigen/Eigenvalues>

#include "element_checks.hpp"
#include "fe/elements/beam.hpp"
#include "fe/elements/thermal_loads.hpp"
#include "small_model.hpp"

namespace bough::fe::test {
namespace {

SmallModel make_grids() {
  SmallModel m;
  add_two_grids(m);
  add_line_material(m);
  return m;
}

SmallModel make_bar() {
  SmallModel m = make_grids();
  records::Pbar p;
  p.id = 9, p.mid = 1, p.A = 0.5, p.I1 = 0.04, p.I2 = 0.07, p.J = 0.05;
  m.deck.pbar.push_back(p);
  m.deck.beams.push_back(make_beam(false));
  m.make();
  return m;
}

/// Basic by CD axes of both grids.
MatrixXd calc_turn(const SmallModel& m) {
  MatrixXd R = MatrixXd::Zero(12, 12);
  for (int k = 0; k < 4; ++k) R.block<3, 3>(3 * k, 3 * k) = m.nodes.node(k / 2).R_basic_cd;
  return R;
}

TEST(Genel, FlexibilityOfACantileverIsTheBar) {
  const SmallModel bar = make_bar();
  const MatrixXd R = calc_turn(bar), K = bar.calc_stiffness();
  const MatrixXd Z = (R.transpose() * K * R).bottomRightCorner<6, 6>().inverse();
  for (const bool by_stiffness : {false, true}) {
    SmallModel m = make_grids();
    records::Genel e;
    e.id = 5;
    for (int c = 1; c <= 6; ++c) {
      e.ui.push_back({2, c});
      e.ud.push_back({1, c});
    }
    e.is_flexibility = !by_stiffness;
    e.matrix = by_stiffness ? MatrixXd(Z.inverse()) : Z;
    m.deck.special.genel.push_back(e);
    m.make();
    EXPECT_LT((m.calc_stiffness() - K).norm(), 1e-11 * K.norm()) << by_stiffness;
    EXPECT_TRUE(m.calc_mass(MassKind::Lumped).isZero(0));
  }
}

TEST(Genel, GivenSAndScalarPoints) {
  SmallModel m = make_grids();
  m.nodes.add_scalar_point(51);
  records::Genel e;
  e.id = 5;
  e.ui = {{1, 2}, {51, 0}};
  e.ud = {{2, 4}};
  e.matrix = Eigen::Matrix2d{{5, 1}, {1, 3}};
  e.s = Eigen::Vector2d(0.5, -2);
  m.deck.special.genel.push_back(e);
  m.make();
  // Energy of the deformations d = u_i - S u_d.
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  VectorXd u(13);
  for (double& x : u) x = normal(random);
  const double u_d = make_rotation(12).col(0).dot(u.segment<3>(9));
  const Eigen::Vector2d d(make_rotation(11).col(1).dot(u.segment<3>(0)) - 0.5 * u_d, u[12] + 2 * u_d);
  EXPECT_NEAR(u.dot(m.calc_stiffness() * u), d.dot(e.matrix * d), 1e-12);
}

TEST(Genel, PlaneUdHoldsAPlaneBody) {
  SmallModel m;
  const Vector3d arm(3, 2, 0);
  m.nodes.add_grid(1, {1, 1, 5});
  m.nodes.add_grid(2, Vector3d(1, 1, 5) + arm);
  records::Genel e;
  e.id = 5;
  e.ui = {{1, 1}, {1, 2}, {1, 6}};
  e.ud = {{2, 1}, {2, 2}, {2, 6}};
  e.matrix = Eigen::Matrix3d{{6, 1, 0}, {1, 7, 3}, {0, 3, 2}};
  m.deck.special.genel.push_back(e);
  m.make();
  // u_i of the body that moves by u_d: its translation, and the turn times the arm back.
  const Eigen::Matrix3d S{{1, 0, arm.y()}, {0, 1, -arm.x()}, {0, 0, 1}};
  MatrixXd B = MatrixXd::Zero(3, 12);
  const std::array dofs{0, 1, 5};
  for (int i = 0; i < 3; ++i) {
    B(i, dofs[i]) = 1;
    for (int j = 0; j < 3; ++j) B(i, 6 + dofs[j]) = -S(i, j);
  }
  EXPECT_LT((m.calc_stiffness() - B.transpose() * e.matrix * B).norm(), 1e-12);
}

TEST(Genel, BadInputIsReported) {
  const auto diagnose = [](const auto& change) {
    SmallModel m = make_grids();
    records::Genel e;
    e.id = 5;
    e.ui = {{2, 1}};
    e.matrix = MatrixXd::Identity(1, 1);
    change(e);
    m.deck.special.genel.push_back(e);
    Diagnostics d;
    make_elements(m.deck, m.nodes, d);
    return d;
  };
  EXPECT_EQ(diagnose([](auto&) {}).num_errors(), 0);
  EXPECT_TRUE(diagnose([](auto& e) { e.ui[0].g = 99; }).has("fe.missing-grid"));
  EXPECT_TRUE(diagnose([](auto& e) { e.ui[0].c = 0; }).has("fe.bad-component"));
  EXPECT_TRUE(diagnose([](auto& e) { e.ud = {{1, 1}}; }).has("fe.rigid-independent"));
  EXPECT_TRUE(diagnose([](auto& e) { e.ud = {{1, 1}, {1, 1}}; }).has("fe.rigid-independent"));
  EXPECT_TRUE(diagnose([](auto& e) { e.is_flexibility = true, e.matrix(0, 0) = -1; }).has("fe.bad-property"));
}

TEST(Cgap, IsASpringOfItsStateAtTheStart) {
  const auto stretch = [](double u0, double f0) {
    SmallModel m = make_grids();
    m.deck.special.pgap.push_back({9, u0, f0, 100, 0.5, 7, {}});
    records::Cgap gap;
    gap.id = 5, gap.pid = 9, gap.ga = 1, gap.gb = 2;
    m.deck.special.cgap.push_back(gap);
    m.make();
    EXPECT_EQ(m.elements[0]->card(), "CGAP");
    const MatrixXd K = m.calc_stiffness(), rigid = m.nodes.calc_rigid_modes();
    EXPECT_LT((K * rigid).norm(), 1e-11 * K.norm());
    const Vector3d ex = (kPointB - kPointA).normalized(), ey = ex.unitOrthogonal();
    const Matrix3d K_bb = K.block<3, 3>(6, 6);
    return Eigen::Vector3d(ex.dot(K_bb * ex), ey.dot(K_bb * ey), ex.dot(K_bb * ey));
  };
  EXPECT_LT((stretch(0, 0) - Vector3d(100, 7, 0)).norm(), 1e-12);
  EXPECT_LT((stretch(0.1, 3) - Vector3d(100, 7, 0)).norm(), 1e-12);
  EXPECT_LT((stretch(0.1, 0) - Vector3d(0.5, 0, 0)).norm(), 1e-12);
}

TEST(Cgap, CoincidentGridsNeedCid) {
  SmallModel m = make_grids();
  m.nodes.add_grid(3, kPointA);
  m.deck.special.pgap.push_back({9, 0, 0, 100, 0.5, 7, {}});
  records::Cgap gap;
  gap.id = 5, gap.pid = 9, gap.ga = 1, gap.gb = 3;
  m.deck.special.cgap.push_back(gap);
  Diagnostics d;
  make_elements(m.deck, m.nodes, d);
  EXPECT_TRUE(d.has("fe.bad-orientation"));
  m.deck.special.cgap[0].cid = 7;
  m.make();
  const Vector3d x = make_rotation(13).col(0);
  EXPECT_NEAR(x.dot(m.calc_stiffness().block<3, 3>(0, 0) * x), 100, 1e-12);
  m.deck.special.cgap[0].pid = 8;
  Diagnostics missing;
  make_elements(m.deck, m.nodes, missing);
  EXPECT_TRUE(missing.has("fe.missing-property"));
}

records::Pbcomp make_pbcomp() {
  records::Pbcomp p;
  p.id = 9, p.mid = 1, p.A = 0.5, p.I1 = 0.04, p.I2 = 0.07, p.I12 = 0.01, p.J = 0.05, p.nsm = 0.2;
  p.k1 = 0.8, p.k2 = 0.6, p.m = Eigen::Vector2d(0.1, -0.05), p.n = Eigen::Vector2d(0.03, 0.02);
  return p;
}

SmallModel make_composite(const records::Pbcomp& p) {
  SmallModel m = make_grids();
  records::Mat1 other;
  other.id = 2, other.E = 9, other.G = 3, other.rho = 0.2;
  m.deck.mat1.push_back(other);
  m.deck.special.pbcomp.push_back(p);
  m.deck.beams.push_back(make_beam(true));
  m.make();
  return m;
}

TEST(Pbcomp, OfOneMaterialIsThePbeam) {
  auto p = make_pbcomp();
  p.section = 5;
  p.lumps = {{{0.1, 0.2}, 0, 1}, {{-0.1, 0.3}, 0, 1}};  // without fractions: where stresses are printed
  const SmallModel composite = make_composite(p);
  SmallModel beam = make_grids();
  records::Pbeam q;
  q.id = 9, q.mid = 1;
  for (const double x : {0.0, 1.0}) q.stations.push_back({x, p.A, p.I1, p.I2, p.I12, p.J, p.nsm, {}});
  q.k1 = 0.8, q.k2 = 0.6;
  q.m1_a = q.m1_b = 0.1, q.m2_a = q.m2_b = -0.05, q.n1_a = q.n1_b = 0.03, q.n2_a = q.n2_b = 0.02;
  beam.deck.pbeam.push_back(q);
  beam.deck.beams.push_back(make_beam(true));
  beam.make();
  EXPECT_LT((composite.calc_stiffness() - beam.calc_stiffness()).norm(), 1e-13 * beam.calc_stiffness().norm());
  for (MassKind kind : {MassKind::Lumped, MassKind::Consistent})
    EXPECT_LT((composite.calc_mass(kind) - beam.calc_mass(kind)).norm(), 1e-14);
}

/// Lumps count before I1, I2 of the card, blank or not: 2 (0.3, 0.2) and 2 (-0.1, 0.4) of A/4 each, mirrored in z.
TEST(Pbcomp, OfLumpsOfOneMaterialBendsByTheLumps) {
  auto p = make_pbcomp();
  p.section = 2;
  p.lumps = {{{0.3, 0.2}, 0.25, 1}, {{-0.1, 0.4}, 0.25, 1}};
  p.n.setZero();
  const double A = p.A, y = 0.1, I1 = A * 0.04, I2 = A / 2 * (0.04 + 0.16);
  for (const double given : {0.0, 0.5}) {
    p.I1 = p.I2 = given;
    p.I12 = 0;
    const SmallModel m = make_composite(p);
    const BeamSection& s = dynamic_cast<const Beam&>(*m.elements[0]).property().stations.front();
    EXPECT_NEAR(s.A, A, 1e-15);
    EXPECT_NEAR(s.I1, I1, 1e-15);
    EXPECT_NEAR(s.I2, I2, 1e-15);
    EXPECT_EQ(s.I12, 0);
    EXPECT_NEAR(s.n[0], y, 1e-15);
    EXPECT_NEAR(s.n[1], 0, 1e-15);
    EXPECT_EQ(s.nsm, p.nsm);
  }
}

TEST(Pbcomp, OfSeveralMaterialsWeighsItsLumps) {
  auto p = make_pbcomp();
  p.section = 2;  // mirrored at the y axis: z changes its sign
  p.lumps = {{{0.3, 0.2}, 0.1, 1}, {{-0.1, 0.4}, 0.4, 2}};
  const SmallModel m = make_composite(p);
  // By hand: E1 = 3 on 2 x 0.05 at y = 0.3, E2 = 9 on 2 x 0.2 at y = -0.1.
  const double e1 = 0.1, e2 = 0.4 * 3, A = e1 + e2, y = (e1 * 0.3 - e2 * 0.1) / A;
  const auto* beam = dynamic_cast<const Beam*>(m.elements[0].get());
  ASSERT_NE(beam, nullptr);
  const BeamSection& s = beam->property().stations.front();
  EXPECT_NEAR(s.A, A, 1e-15);
  EXPECT_NEAR(s.n[0], y, 1e-15);
  EXPECT_NEAR(s.n[1], 0, 1e-15);
  EXPECT_NEAR(s.I1, e1 * std::pow(0.3 - y, 2) + e2 * std::pow(0.1 + y, 2), 1e-15);
  EXPECT_NEAR(s.I2, e1 * 0.04 + e2 * 0.16, 1e-15);
  EXPECT_EQ(s.I12, 0);
  EXPECT_EQ(s.J, p.J);
  const double m1 = 0.1 * 0.8, m2 = 0.4 * 0.2, mass = m1 + m2 + 0.2;
  EXPECT_NEAR(s.nsm, mass, 1e-15);
  EXPECT_NEAR(s.m[0], (m1 * 0.3 - m2 * 0.1 + 0.2 * 0.1) / mass, 1e-15);
  EXPECT_NEAR(s.m[1], -0.2 * 0.05 / mass, 1e-15);
  const MatrixXd rigid = m.nodes.calc_rigid_modes();
  const MatrixXd M = rigid.transpose() * m.calc_mass(MassKind::Consistent) * rigid;
  EXPECT_NEAR(M(0, 0), mass * (kPointB - kPointA).norm(), 1e-13);
  EXPECT_LT((m.calc_stiffness() * rigid).norm(), 1e-12 * m.calc_stiffness().norm());
}

constexpr double kR = 2;

/// A quarter circle of radius 2 about the origin of `R`, from its x to its y axis.
SmallModel make_bend(const Matrix3d& R, int geom, const Vector3d& v) {
  SmallModel m;
  m.nodes.add_grid(1, R * Vector3d(kR, 0, 0), R);
  m.nodes.add_grid(2, R * Vector3d(0, kR, 0));
  records::Mat1 material;
  material.id = 1, material.E = 3, material.G = 1.1, material.rho = 0.8;
  m.deck.mat1.push_back(material);
  records::Pbend p;
  p.id = 9, p.mid = 1, p.A = 50, p.I1 = 0.04, p.I2 = 0.07, p.J = 0.05, p.nsm = 3, p.rb = kR, p.theta_b_deg = 90;
  m.deck.special.pbend.push_back(p);
  records::Cbend e;
  e.id = 5, e.pid = 9, e.ga = 1, e.gb = 2, e.geom = geom, e.v = v;
  m.deck.special.cbend.push_back(e);
  m.make();
  return m;
}

TEST(Cbend, QuarterRingBendsAsTheThinRing) {
  const SmallModel m = make_bend(Matrix3d::Identity(), 1, Vector3d(-1, 0, 0));
  VectorXd f = VectorXd::Zero(12);
  // Timoshenko, Strength of Materials II: a radial force at the tip of a quarter ring, M = P R sin φ, N = -P sin φ.
  f[7] = 1;
  const VectorXd in_plane = solve_static(m.calc_stiffness(), f, {0, 1, 2, 3, 4, 5});
  const double pi = 3.141592653589793, EI1 = 3 * 0.04, EI2 = 3 * 0.07, GJ = 1.1 * 0.05, EA = 150;
  EXPECT_NEAR(in_plane[7], pi * kR / 4 * (kR * kR / EI1 + 1 / EA), 1e-11 * in_plane[7]);
  // Across its plane: P R³ (π/(4 EI) + (3π/4 - 2)/GJ).
  f.setZero();
  f[8] = 1;
  const VectorXd across = solve_static(m.calc_stiffness(), f, {0, 1, 2, 3, 4, 5});
  EXPECT_NEAR(across[8], kR * kR * kR * (pi / (4 * EI2) + (0.75 * pi - 2) / GJ), 1e-11 * across[8]);
  // Mass of the arc's length, its centre at 2R/π on the bisector.
  const MatrixXd rigid = m.nodes.calc_rigid_modes();
  const double mass = (0.8 * 50 + 3) * pi / 2 * kR;
  const MatrixXd M = rigid.transpose() * m.calc_mass(MassKind::Consistent) * rigid;
  EXPECT_NEAR(M(0, 0), mass, 1e-12 * mass);
  EXPECT_NEAR(M(1, 5), mass * 2 * kR / pi, 5e-4 * mass * kR);
  EXPECT_NEAR((rigid.transpose() * m.calc_mass(MassKind::Lumped) * rigid)(0, 0), M(0, 0), 1e-12 * mass);
}

TEST(Cbend, EveryGeomIsTheSameArc) {
  const Matrix3d R = make_rotation(5);
  const MatrixXd K = make_bend(R, 1, Vector3d(-3, 0, 0)).calc_stiffness();
  const MatrixXd K_0 = make_bend(Matrix3d::Identity(), 1, Vector3d(-1, 0, 0)).calc_stiffness();
  MatrixXd turn = MatrixXd::Zero(12, 12);
  for (int i = 0; i < 12; i += 3) turn.block<3, 3>(i, i) = R;
  EXPECT_LT((turn.transpose() * K * turn - K_0).norm(), 1e-11 * K.norm());
  EXPECT_LT((make_bend(R, 1, Vector3d(2, 0, 0)).calc_stiffness() - K).norm(), 1e-11 * K.norm());  // the line goes on
  EXPECT_LT((make_bend(R, 2, Vector3d(0, 2, 0)).calc_stiffness() - K).norm(), 1e-11 * K.norm());
  for (const int geom : {3, 4})
    EXPECT_LT((make_bend(R, geom, Vector3d(1, 2, 0)).calc_stiffness() - K).norm(), 1e-11 * K.norm()) << geom;
}

TEST(Cbend, OwesWhatEveryElementOwes) {
  const SmallModel m = make_bend(make_rotation(6), 2, Vector3d(0, 1, 0));
  const MatrixXd K = m.calc_stiffness(), rigid = m.nodes.calc_rigid_modes();
  EXPECT_LT((K - K.transpose()).norm(), 1e-14 * K.norm());
  EXPECT_LT((K * rigid).norm(), 1e-10 * K.norm());
  const VectorXd lambda = Eigen::SelfAdjointEigenSolver<MatrixXd>(K).eigenvalues();
  EXPECT_EQ((lambda.array() > 1e-9 * K.norm()).count(), 6);
  std::mt19937 random(21);
  std::normal_distribution<double> normal;
  VectorXd u(12);
  for (double& x : u) x = normal(random);
  // Forces at the ends are those of K u; K_G turns them.
  VectorXd force(12);
  m.elements[0]->stress_state()->calc_internal_forces(u, force);
  const VectorXd f = K * u;
  EXPECT_NEAR(force[6], (make_rotation(6) * Vector3d(-1, 0, 0)).dot(f.segment<3>(6)), 1e-10 * f.norm());
  EXPECT_NEAR(force[0], -(make_rotation(6) * Vector3d(0, 1, 0)).dot(f.segment<3>(0)), 1e-10 * f.norm());
  const MatrixXd K_G = m.calc_geometric_stiffness(u);
  EXPECT_LT((K_G - K_G.transpose()).norm(), 1e-12 * K_G.norm());
  EXPECT_LT((K_G * rigid.leftCols<3>()).norm(), 1e-9 * K_G.norm());
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d theta = Vector3d::Unit(axis);
    VectorXd expected(12);
    for (int i = 0; i < 12; i += 6) {
      expected.segment<3>(i) = theta.cross(f.segment<3>(i));
      expected.segment<3>(i + 3) = 0.5 * theta.cross(f.segment<3>(i + 3));
    }
    EXPECT_LT((K_G * rigid.col(3 + axis) - expected).norm(), 1e-8 * expected.norm()) << axis;
  }
  expect_third_derivative_of_geometric(m);
}

TEST(Cbend, GrowsAlikeInAllDirections) {
  SmallModel m = make_bend(make_rotation(6), 2, Vector3d(0, 1, 0));
  m.deck.mat1[0].alpha = 2e-3;
  m.deck.mat1[0].tref = 10;
  m.make();
  const Element& bend = *m.elements[0];
  ASSERT_NE(bend.thermal_loads(), nullptr);
  ElementTemperature T;
  T.node = Eigen::Vector2d(20, 40);
  const ThermalState state = bend.thermal_loads()->calc_thermal(T);
  const VectorXd& load = state.load;
  // Held at A it grows freely about A: no force, no rotation, no energy.
  const VectorXd u = solve_static(m.calc_stiffness(), load, {0, 1, 2, 3, 4, 5});
  const Vector3d grown = 2e-3 * 20 * (make_rotation(6) * Vector3d(-kR, kR, 0));
  EXPECT_LT((u.segment<3>(6) - grown).norm(), 1e-12);
  EXPECT_LT(u.segment<3>(9).norm(), 1e-12);
  VectorXd force(12);
  bend.stress_state()->calc_internal_forces(u, force);
  EXPECT_LT((force + state.force).norm(), 1e-11 * force.norm());
  EXPECT_NEAR(state.energy, 0.5 * u.dot(m.calc_stiffness() * u), 1e-12 * state.energy);
  EXPECT_LT((m.nodes.calc_rigid_modes().transpose() * load).norm(), 1e-12 * load.norm());
}

TEST(Cbend, BadInputIsReported) {
  const auto diagnose = [](const auto& change) {
    SmallModel m = make_bend(Matrix3d::Identity(), 3, Vector3d(1, 2, 0));
    change(m.deck.special.cbend[0], m.deck.special.pbend[0]);
    Diagnostics d;
    make_elements(m.deck, m.nodes, d);
    return d;
  };
  EXPECT_EQ(diagnose([](auto&, auto&) {}).num_errors(), 0);
  EXPECT_TRUE(diagnose([](auto&, auto& p) { p.rb = 1; }).has("fe.bad-orientation"));
  EXPECT_TRUE(diagnose([](auto& e, auto&) { e.v = Vector3d(-2, 2, 0); }).has("fe.bad-orientation"));
  EXPECT_TRUE(diagnose([](auto&, auto& p) { p.rc = 0.1; }).has("fe.bad-property"));
  EXPECT_TRUE(diagnose([](auto&, auto& p) { p.is_pipe = true, p.fsi = 2, p.rm = 1, p.t = .1; }).has("fe.bad-property"));
  EXPECT_EQ(diagnose([](auto&, auto& p) { p.is_pipe = true, p.fsi = 1, p.rm = 1, p.t = .1; }).num_errors(), 0);
  EXPECT_TRUE(diagnose([](auto& e, auto&) { e.pid = 8; }).has("fe.missing-property"));
}

TEST(Pbcomp, BadInputIsReported) {
  auto p = make_pbcomp();
  p.lumps = {{{0.1, 0.2}, 0, 2}};
  SmallModel m = make_grids();
  m.deck.special.pbcomp.push_back(p);
  m.deck.beams.push_back(make_beam(true));
  Diagnostics d;
  make_elements(m.deck, m.nodes, d);
  EXPECT_TRUE(d.has("fe.missing-material"));
  EXPECT_TRUE(d.has("fe.bad-property"));  // no fraction C says how much of the area they are
}

}  // namespace
}  // namespace bough::fe::test
