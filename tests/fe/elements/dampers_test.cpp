/// Dampers: CDAMP1 to 4, CVISC, CBUSH with B, CBUSH1D. B against rates written down by hand; rigid motions; storage.
#include <gmock/gmock.h>

#include <Eigen/Eigenvalues>

#include "small_model.hpp"

namespace bough::fe::test {
namespace {

SmallModel make_two_grids() {
  SmallModel m;
  add_two_grids(m);
  return m;
}

MatrixXd calc_damping(const SmallModel& m) {
  MatrixXd B = MatrixXd::Zero(m.nodes.num_gdofs(), m.nodes.num_gdofs());
  for (const auto& element : m.elements) {
    MatrixXd B_e = MatrixXd::Constant(element->num_dofs(), element->num_dofs(), 2.0);
    if (element->damping()) element->damping()->add_damping(0.5, B_e);
    const auto& g = element->gdofs();
    B(g, g) += 2 * (B_e.array() - 2.0).matrix();  // adds, scaled, to what is there
  }
  return B;
}

void expect_sound(const SmallModel& m, int rank) {
  const MatrixXd B = calc_damping(m);
  const double scale = B.cwiseAbs().maxCoeff();
  EXPECT_NE(m.elements.front()->damping(), nullptr);
  EXPECT_LT((B - B.transpose()).cwiseAbs().maxCoeff(), 1e-14 * scale);
  EXPECT_LT((B * m.nodes.calc_rigid_modes()).cwiseAbs().maxCoeff(), 1e-13 * scale);
  const VectorXd lambda = Eigen::SelfAdjointEigenSolver<MatrixXd>(B).eigenvalues();
  EXPECT_EQ((lambda.array() > 1e-11 * scale).count(), rank) << lambda.transpose();
  EXPECT_GE(lambda.minCoeff(), -1e-13 * scale);
}

TEST(Dampers, ViscousActsAlongAndAboutItsLine) {
  SmallModel m = make_two_grids();
  m.deck.pvisc.push_back({9, 3.0, 0.5, {}});
  m.deck.cvisc.push_back({5, 9, 1, 2, {}});
  m.make();
  expect_sound(m, 2);
  EXPECT_EQ(m.calc_stiffness().norm(), 0);
  EXPECT_EQ(m.calc_mass(MassKind::Lumped).norm(), 0);
  const Vector3d a = (kPointB - kPointA).normalized();
  VectorXd rate = VectorXd::Zero(12);
  rate.segment<3>(6) = Vector3d(0.2, -0.4, 1.1);  // power is ce (extension rate)^2 + cr (twist rate)^2
  rate.segment<3>(9) = Vector3d(-0.7, 0.3, 0.6);
  const double extension = a.dot(rate.segment<3>(6)), twist = a.dot(rate.segment<3>(9));
  EXPECT_NEAR(rate.dot(calc_damping(m) * rate), 3 * extension * extension + 0.5 * twist * twist, 1e-14);
}

TEST(Dampers, BushDampsAsItsSpringsHold) {
  SmallModel m = make_two_grids();
  records::Pbush p;
  p.id = 9, p.k = {2, 4, 6, 0.8, 1.0, 1.2}, p.b = {1, 2, 3, 0.4, 0.5, 0.6};
  m.deck.pbush.push_back(p);
  records::Cbush e;
  e.id = 5, e.pid = 9, e.ga = 1, e.gb = 2, e.cid = 7, e.ocid = 7, e.s_offset = Vector3d(0.1, 0.2, 0.3);
  m.deck.cbush.push_back(e);
  m.make();
  expect_sound(m, 6);
  EXPECT_LT((2 * calc_damping(m) - m.calc_stiffness()).norm(), 1e-14);
}

TEST(Dampers, BushWithDampingAcrossNeedsAnOrientation) {
  SmallModel m = make_two_grids();
  records::Pbush p;
  p.id = 9, p.b = {1, 2, 0, 0, 0, 0};
  m.deck.pbush.push_back(p);
  records::Cbush e;
  e.id = 5, e.pid = 9, e.ga = 1, e.gb = 2;
  m.deck.cbush.push_back(e);
  Diagnostics diagnostics;
  make_elements(m.deck, m.nodes, diagnostics);
  ASSERT_EQ(diagnostics.num_errors(), 1);
  EXPECT_EQ(diagnostics.items()[0].id, "fe.bad-orientation");
}

TEST(Dampers, Bush1dIsASpringADamperAndAMass) {
  SmallModel m = make_two_grids();
  m.deck.pbush1d.push_back({9, 4.0, 2.0, 0.6, {}});
  m.deck.cbush1d.push_back({5, 9, 1, 2, {}, {}});
  m.make();
  expect_sound(m, 1);
  EXPECT_LT((2 * calc_damping(m) - m.calc_stiffness()).norm(), 1e-14);
  const MatrixXd Phi_R = m.nodes.calc_rigid_modes();
  EXPECT_LT(((Phi_R.transpose() * m.calc_mass(MassKind::Consistent) * Phi_R).topLeftCorner<3, 3>() -
             0.6 * Matrix3d::Identity())
                .norm(),
            1e-14);
  // K_G is the change of the force k (l - L) along the present line: against differences of the exact force.
  VectorXd u = VectorXd::Zero(12);
  const Vector3d line = kPointB - kPointA;
  u.segment<3>(6) = 1e-6 * line;  // a small pull, along the line
  const MatrixXd K_T = m.calc_stiffness() + m.calc_geometric_stiffness(u);
  const auto calc_force = [&](const Vector3d& d) {
    const Vector3d now = line + u.segment<3>(6) + d;
    return Vector3d(4.0 * (now.norm() - line.norm()) * now.normalized());
  };
  for (int i = 0; i < 3; ++i) {
    const double h = 1e-4;
    const Vector3d slope = (calc_force(h * Vector3d::Unit(i)) - calc_force(-h * Vector3d::Unit(i))) / (2 * h);
    EXPECT_LT((slope - K_T.block<3, 1>(6, 6 + i)).norm(), 2e-8);
  }
  EXPECT_GT(m.calc_geometric_stiffness(u).norm(), 1e-6);
}

TEST(Dampers, Bush1dAlongASystemReachesGround) {
  SmallModel m = make_two_grids();
  m.deck.pbush1d.push_back({9, 4.0, 2.0, 0, {}});
  records::Cbush1d e;
  e.id = 5, e.pid = 9, e.ga = 1, e.cid = 7;
  m.deck.cbush1d.push_back(e);
  m.make();
  const Vector3d x = make_rotation(13).col(0);
  MatrixXd expected = MatrixXd::Zero(12, 12);
  expected.topLeftCorner<3, 3>() = 2 * x * x.transpose();
  EXPECT_LT((calc_damping(m) - expected).norm(), 1e-14);
  EXPECT_LT((m.calc_stiffness() - 2 * expected).norm(), 1e-14);
  EXPECT_EQ(m.calc_geometric_stiffness(VectorXd::Ones(12)).norm(), 0);
}

TEST(Dampers, ScalarDampersActInTheDisplacementAxes) {
  SmallModel m = make_two_grids();
  m.nodes.add_scalar_point(3);
  m.deck.pdamp.push_back({9, 5.0, {}});
  m.deck.dampers.push_back({5, 9, 0, 1, 2, 2, 6, {}});          // CDAMP1: y of grid 1, rotation z of grid 2
  m.deck.dampers.push_back({6, 0, 7.0, 3, 0, 0, 0, {}, true});  // CDAMP4: scalar point to ground
  m.make();
  EXPECT_THAT(m.elements[0]->card(), "CDAMP1");
  EXPECT_THAT(m.elements[1]->card(), "CDAMP4");
  VectorXd b = VectorXd::Zero(13);
  b.head<3>() = make_rotation(11).col(1);
  b.segment<3>(9) = -make_rotation(12).col(2);
  MatrixXd expected = 5 * b * b.transpose();
  expected(12, 12) = 7;
  EXPECT_LT((calc_damping(m) - expected).norm(), 1e-14);
}

TEST(Dampers, WrongOnesAreReportedTogether) {
  SmallModel m = make_two_grids();
  m.nodes.add_grid(4, kPointA);
  m.deck.pvisc.push_back({9, 3.0, 0.5, {}});
  m.deck.pbush1d.push_back({9, 4.0, 2.0, 0.6, {}});
  m.deck.cvisc.push_back({5, 9, 1, 4, {}});
  m.deck.cvisc.push_back({6, 8, 1, 2, {}});
  m.deck.cbush1d.push_back({7, 9, 1, 4, {}, {}});
  m.deck.cbush1d.push_back({8, 8, 1, 99, {}, {}});
  m.deck.dampers.push_back({10, 8, 0, 1, 1, 0, 0, {}});
  Diagnostics diagnostics;
  make_elements(m.deck, m.nodes, diagnostics);
  std::vector<std::string> ids;
  for (const auto& item : diagnostics.items()) ids.push_back(item.id);
  EXPECT_THAT(ids, testing::UnorderedElementsAre("fe.zero-length", "fe.missing-property", "fe.zero-length",
                                                 "fe.missing-property", "fe.missing-grid", "fe.missing-property"));
}

}  // namespace
}  // namespace bough::fe::test
