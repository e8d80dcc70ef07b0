/// Laminates against hand numbers, material axes (THETA, MCID, CORDM), and what the makers report.
#include <cmath>
#include <numbers>

#include "fe/elements/solid.hpp"
#include "fe/sections/laminate.hpp"
#include "small_model.hpp"

namespace bough::fe::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

PlaneMaterial make_ply() { return make_orthotropic_plane(140, 10, 0.3, 5, 5, 3, 1.6); }

TEST(Laminate, IsotropicPlate) {
  const auto m = make_isotropic_plane(2.6, 1, 0.3, 4);
  const auto s = make_laminate_section({{m, 0.1}, {m, 0.2}, {m, 0.1}}, -0.2);
  EXPECT_NEAR(s.A(0, 0), 2.6 / 0.91 * 0.4, 1e-14);
  EXPECT_NEAR(s.D(0, 1), 0.3 * 2.6 / 0.91 * 0.064 / 12, 1e-14);
  EXPECT_NEAR(s.S(0, 0), 5.0 / 6 * 0.4, 1e-14);
  EXPECT_NEAR(s.S(1, 1), 5.0 / 6 * 0.4, 1e-14);
  EXPECT_EQ(s.B.norm(), 0);
  EXPECT_NEAR(s.mass, 1.6, 1e-14);
  EXPECT_NEAR(s.rotary_inertia, 4 * 0.064 / 12, 1e-14);
}

TEST(Laminate, CrossPlyByHand) {
  const auto ply = make_ply();
  const double c = 1 - 0.09 * 10 / 140.0, Q11 = 140 / c, Q22 = 10 / c, Q12 = 3 / c;
  const auto at = [&](double degrees) { return rotate_material(ply, degrees * kDegree); };
  const auto s = make_laminate_section({{at(0), 1}, {at(90), 1}, {at(90), 1}, {at(0), 1}}, -2);
  EXPECT_NEAR(s.A(0, 0), 2 * Q11 + 2 * Q22, 1e-12);
  EXPECT_NEAR(s.A(0, 1), 4 * Q12, 1e-12);
  EXPECT_NEAR(s.D(0, 0), (Q11 * (8 - 1) + Q22) * 2 / 3, 1e-12);
  EXPECT_NEAR(s.D(1, 1), (Q22 * (8 - 1) + Q11) * 2 / 3, 1e-12);
  EXPECT_NEAR(s.D(2, 2), 5 * 64.0 / 12, 1e-12);
  EXPECT_EQ(s.B.norm(), 0);
  // 0 below, 90 above: B11 = (Q22 - Q11) h² / 8 with h = 2.
  const auto two = make_laminate_section({{at(0), 1}, {at(90), 1}}, -1);
  EXPECT_NEAR(two.B(0, 0), (Q22 - Q11) / 2, 1e-12);
  EXPECT_NEAR(two.B(1, 1), (Q11 - Q22) / 2, 1e-12);
  EXPECT_NEAR(two.B(0, 1), 0, 1e-12);
}

TEST(Laminate, QuasiIsotropicMembrane) {
  const auto ply = make_ply();
  std::vector<LaminateLayer> layers;
  for (double degrees : {0.0, 45.0, -45.0, 90.0}) layers.push_back({rotate_material(ply, degrees * kDegree), 0.25});
  const auto s = make_laminate_section(layers, -0.5);
  EXPECT_NEAR(s.A(0, 0), s.A(1, 1), 1e-12);
  EXPECT_NEAR(s.A(2, 2), (s.A(0, 0) - s.A(0, 1)) / 2, 1e-12);
  EXPECT_NEAR(s.A(0, 2), 0, 1e-12);
  EXPECT_GT(s.B.norm(), 0.1);
}

/// Thin stiff faces on a soft core of height c: S = G_c d² / c (Allen, "Analysis and design of structural sandwich
/// panels", 1969, 2.3), d between the mid-surfaces of the faces.
TEST(Laminate, SandwichShear) {
  const auto face = make_isotropic_plane(1e4, 4e3, 0.25, 1), core = make_isotropic_plane(1e-4, 0.7, 0.25, 1);
  const double t = 1e-3, c = 0.5, d = c + t;
  const auto s = make_laminate_section({{face, t}, {core, c}, {face, t}}, -c / 2 - t);
  EXPECT_NEAR(s.S(0, 0) / (0.7 * d * d / c), 1, 1e-5);
}

/// The law turned by an angle, against stresses turned as tensors.
TEST(Laminate, RotationIsThatOfTensors) {
  const auto ply = make_ply();
  const double angle = 0.4;
  const Eigen::Rotation2Dd R(angle);
  const Eigen::Vector3d strain(0.3, -0.2, 0.5);
  Eigen::Matrix2d e, s;
  e << strain[0], strain[2] / 2, strain[2] / 2, strain[1];
  const Eigen::Matrix2d e1 = R.matrix().transpose() * e * R.matrix();
  const Eigen::Vector3d s1 = ply.Q * Eigen::Vector3d(e1(0, 0), e1(1, 1), 2 * e1(0, 1));
  s << s1[0], s1[2], s1[2], s1[1];
  s = R.matrix() * s * R.matrix().transpose();
  const Eigen::Vector3d turned = rotate_material(ply, angle).Q * strain;
  EXPECT_LT((turned - Eigen::Vector3d(s(0, 0), s(1, 1), s(0, 1))).norm(), 1e-12);
}

/// A unit square of an orthotropic plate, first side along `first`.
SmallModel make_square(int first, double theta, std::optional<int> mcid = {}) {
  SmallModel m;
  m.deck.mat8.push_back({5, 140, 10, 0.3, 5, 5, 3, 1.6, {}});
  records::Pshell p;
  p.id = 1, p.mid1 = p.mid2 = p.mid3 = 5, p.t = 0.1;
  m.deck.pshell.push_back(p);
  const double c = std::cos(10 * kDegree), s = std::sin(10 * kDegree);
  for (const auto& [id, x, y] : {std::tuple(1, 0, 0), std::tuple(2, 1, 0), std::tuple(3, 1, 1), std::tuple(4, 0, 1)})
    m.nodes.add_grid(id, Vector3d(c * x - s * y, s * x + c * y, 0));
  m.nodes.add_system(7, Vector3d(5, 5, 5), Eigen::AngleAxisd(25 * kDegree, Vector3d::UnitZ()).toRotationMatrix());
  records::ShellElement e;
  e.id = 1, e.pid = 1, e.card = "CQUAD4", e.theta_deg = theta, e.mcid = mcid;
  for (int k = 0; k < 4; ++k) e.grids.push_back((first + k) % 4 + 1);
  m.deck.shells.push_back(e);
  m.make();
  return m;
}

TEST(ShellAxes, ThetaFromTheFirstSideAndMcid) {
  const MatrixXd K = make_square(0, 30).calc_stiffness();
  const auto distance = [&](const SmallModel& m) { return (m.calc_stiffness() - K).norm() / K.norm(); };
  EXPECT_LT(distance(make_square(1, -60)), 1e-12);  // side 2-3 stands at 90 degrees
  EXPECT_LT(distance(make_square(3, 120)), 1e-12);
  EXPECT_GT(distance(make_square(0, -30)), 1e-2);
  // Side 1-2 is at 10 degrees, the system at 25.
  EXPECT_LT((make_square(0, 0, 7).calc_stiffness() - make_square(0, 15).calc_stiffness()).norm(), 1e-12 * K.norm());
}

/// MAT9 in a turned system: stresses of a linear field by tensors in the material's axes.
TEST(SolidAxes, LawInTurnedMaterialSystem) {
  SmallModel m;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  records::Mat9 material;
  material.id = 1;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j) material.G(i, j) = material.G(j, i) = normal(random) + (i == j ? 8 : 0);
  m.deck.mat9.push_back(material);
  m.deck.psolid.push_back({1, 1, 7, {}});
  const Matrix3d R = make_rotation(41);
  m.nodes.add_system(7, Vector3d::Zero(), R);
  const std::vector<Vector3d> x = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int k = 0; k < 4; ++k) m.nodes.add_grid(k + 1, x[static_cast<std::size_t>(k)]);
  records::SolidElement e;
  e.id = 1, e.pid = 1, e.card = "CTETRA", e.corners = {1, 2, 3, 4};
  m.deck.solids.push_back(e);
  m.make();
  Matrix3d H;
  H << 1, 2, 3, -4, 5, 6, 7, -8, 10;
  VectorXd u(12), force(6);
  for (int k = 0; k < 4; ++k) u.segment<3>(3 * k) = H * x[static_cast<std::size_t>(k)];
  m.elements[0]->stress_state()->calc_internal_forces(u, force);
  const Matrix3d e1 = R.transpose() * (0.5 * (H + H.transpose())) * R;
  Eigen::Matrix<double, 6, 1> strain;
  strain << e1(0, 0), e1(1, 1), e1(2, 2), 2 * e1(0, 1), 2 * e1(1, 2), 2 * e1(2, 0);
  const Eigen::Matrix<double, 6, 1> s1 = material.G * strain;
  Matrix3d s;
  s << s1[0], s1[3], s1[5], s1[3], s1[1], s1[4], s1[5], s1[4], s1[2];
  s = R * s * R.transpose();
  Eigen::Matrix<double, 6, 1> expected;
  expected << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(2, 0);
  EXPECT_LT((force - expected).norm(), 1e-12 * expected.norm());
}

/// Errors of a deck by id.
TEST(ContinuaErrors, AreReported) {
  SmallModel good = make_square(0, 0);
  {
    auto& e = good.deck.shells[0];
    e.grids = {1, 3, 2, 4};  // crossed
    EXPECT_EQ(count_messages(good, "fe.bad-facet"), 1);
    e.grids = {1, 2, 2, 4};
    EXPECT_EQ(count_messages(good, "fe.bad-facet"), 1);
    e.grids = {1, 2, 3, 9};
    EXPECT_EQ(count_messages(good, "fe.missing-grid"), 1);
    e.grids = {1, 2, 3, 4};
    e.pid = 44;
    EXPECT_EQ(count_messages(good, "fe.missing-property"), 1);
    e.pid = 1;
    good.deck.pshell[0].t.reset();
    EXPECT_EQ(count_messages(good, "fe.bad-property"), 1);
    good.deck.pshell[0].t = 0.1;
    good.deck.pshell[0].mid2 = 12;
    EXPECT_EQ(count_messages(good, "fe.missing-material"), 1);
    good.deck.pshell[0].mid2 = 5;
    good.deck.mat8[0].nu12 = 9;
    EXPECT_EQ(count_messages(good, "fe.bad-material"), 1);
  }
  SmallModel solid;
  for (int k = 0; k < 4; ++k) solid.nodes.add_grid(k + 1, k == 0 ? Vector3d::Zero() : Vector3d(Vector3d::Unit(k - 1)));
  records::Mat1 material;
  material.id = 1, material.E = 3, material.nu = 0.5, material.G = 1;
  solid.deck.mat1.push_back(material);
  solid.deck.psolid.push_back({1, 1, 0, {}});
  records::SolidElement e;
  e.id = 1, e.pid = 1, e.card = "CTETRA", e.corners = {1, 2, 3, 4};
  solid.deck.solids.push_back(e);
  EXPECT_EQ(count_messages(solid, "fe.bad-material"), 1);
  solid.deck.mat1[0].nu = 0.3;
  EXPECT_EQ(count_messages(solid, "fe.bad-material"), 0);
  solid.deck.solids[0].corners = {1, 2, 3, 2};
  EXPECT_EQ(count_messages(solid, "fe.bad-solid"), 1);
}

}  // namespace
}  // namespace bough::fe::test
