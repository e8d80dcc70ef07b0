/// Mass of rods and bars as Nastran couples it: terms by hand, a rod's free vibration, a shaft's torsion.
#include "small_model.hpp"

namespace bough::fe::test {
namespace {

/// CROD, CONROD and a tapered CTUBE between the same two grids, along a skew axis.
SmallModel make_rod(int which, const Vector3d& a, const Vector3d& b) {
  SmallModel m;
  m.nodes.add_grid(1, a);
  m.nodes.add_grid(2, b);
  records::Mat1 material;
  material.id = 1, material.E = 5, material.G = 2, material.rho = 0.7;
  m.deck.mat1.push_back(material);
  if (which == 0) m.deck.prod.push_back({9, 1, 0.4, 0.02, 0, 0.1, {}}), m.deck.crod.push_back({5, 9, 1, 2, {}});
  if (which == 1) m.deck.conrod.push_back({5, 1, 2, 1, 0.4, 0.02, 0, 0.1, {}});
  if (which == 2) m.deck.ptube.push_back({9, 1, 0.5, 0.1, 0.2, 0.3, {}}), m.deck.ctube.push_back({5, 9, 1, 2, {}});
  m.make();
  return m;
}

/// MSC and NX couple along the axis only: 5/12 and 1/12 of the mass there, half and none across.
TEST(VendorMass, RodsCoupleAlongTheirAxis) {
  const Vector3d a(0.2, -1, 0.5), b(1.4, 0.3, 2), axis = (b - a).normalized(), across = axis.unitOrthogonal();
  const double L = (b - a).norm();
  for (const int which : {0, 1}) {
    const SmallModel m = make_rod(which, a, b);
    const double mass = (0.7 * 0.4 + 0.1) * L;
    const MatrixXd M = m.calc_mass(MassKind::Consistent), M_l = m.calc_mass(MassKind::Lumped);
    const Matrix3d aa = M.block<3, 3>(0, 0), ab = M.block<3, 3>(0, 6);
    EXPECT_NEAR(axis.dot(aa * axis), 5 * mass / 12, 1e-14);
    EXPECT_NEAR(axis.dot(ab * axis), mass / 12, 1e-14);
    EXPECT_NEAR(across.dot(aa * across), mass / 2, 1e-14);
    EXPECT_NEAR((ab * across).norm(), 0, 1e-14);
    EXPECT_NEAR(axis.dot(aa * across), 0, 1e-14);
    EXPECT_TRUE(M.block(3, 0, 3, 12).isZero(0));  // no torsional inertia
    // Whatever is rigid has its lumped mass: a rigid turn moves no grid along the axis against the other.
    const MatrixXd R = m.nodes.calc_rigid_modes();
    EXPECT_LT((R.transpose() * (M - M_l) * R).norm(), 1e-13);
  }
}

/// A taper: mass and first moment of ∫μ and ∫μx, with the same coupling of the mean.
TEST(VendorMass, TaperedTubeKeepsItsMass) {
  const Vector3d a(0, 0, 0), b(2, 0, 0);
  const SmallModel m = make_rod(2, a, b);
  const MatrixXd M = m.calc_mass(MassKind::Consistent), R = m.nodes.calc_rigid_modes();
  const auto area = [](double od) { return std::acos(-1.0) / 4 * (od * od - (od - 0.2) * (od - 0.2)); };
  const double mu_a = 0.7 * area(0.5) + 0.2, mu_b = 0.7 * area(0.3) + 0.2, L = 2;
  const MatrixXd rigid = R.transpose() * M * R;
  EXPECT_NEAR(rigid(0, 0), L * (mu_a + mu_b) / 2, 1e-13);
  EXPECT_NEAR(rigid(2, 4), -L * L * (mu_a / 6 + mu_b / 3), 1e-13);
}

/// Axial vibration of a fixed-free rod: 5/12, 1/12 has the error of fourth order in h, lumped and consistent of second.
TEST(VendorMass, AxialFrequencyConvergesWithFourthOrder) {
  const double exact = std::acos(-1.0) / 2;  // E = ρ = A = L = 1
  std::vector<double> error;
  for (const int n : {4, 8}) {
    SmallModel m;
    records::Mat1 material;
    material.id = 1, material.E = 1, material.G = 1, material.rho = 1;
    m.deck.mat1.push_back(material);
    m.deck.prod.push_back({9, 1, 1, 0, 0, 0, {}});
    for (int i = 0; i <= n; ++i) m.nodes.add_grid(i + 1, Vector3d(double(i) / n, 0, 0));
    for (int i = 1; i <= n; ++i) m.deck.crod.push_back({i, 9, i, i + 1, {}});
    m.make();
    std::vector<int> fixed{0};
    for (int i = 0; i <= n; ++i)
      for (int c = 1; c < 6; ++c) fixed.push_back(6 * i + c);
    error.push_back(
        std::abs(calc_frequencies(m.calc_stiffness(), m.calc_mass(MassKind::Consistent), fixed)[0] - exact));
  }
  EXPECT_LT(error[0], 1e-4 * exact);
  EXPECT_NEAR(error[0] / error[1], 16, 0.5);
}

/// NASTRAN BARMASS = 1: a clamped shaft twists at √(G J / ρ (I1 + I2)) π/2L; without it a CBAR has no such mode.
TEST(VendorMass, BarmassGivesTorsionalInertia) {
  ChainOptions options;
  options.num_elements = 16, options.length = 2, options.E = 7, options.G = 3, options.rho = 0.5;
  options.section.A = 0.3, options.section.I1 = 0.02, options.section.I2 = 0.01, options.section.J = 0.004;
  const double exact = std::acos(-1.0) / 4 * std::sqrt(3 * 0.004 / (0.5 * 0.03));
  std::vector<int> fixed;
  for (int dof = 0; dof < 6 * 17; ++dof)
    if (dof < 6 || dof % 6 != 3) fixed.push_back(dof);
  for (const char* cell : {"0", "1"}) {
    SmallModel m = make_bar_chain(options);
    m.elements.clear();
    m.deck.system_cells["BARMASS"] = cell;
    m.make();
    const bool on = cell[0] == '1';
    for (const MassKind kind : {MassKind::Lumped, MassKind::Consistent}) {
      const MatrixXd M = m.calc_mass(kind);
      double twist = 0;
      for (int i = 3; i < M.rows(); i += 6)
        for (int j = 3; j < M.cols(); j += 6) twist += M(i, j);
      EXPECT_NEAR(twist, on ? 0.5 * 0.03 * 2 : 0, 1e-14);
      if (on) {
        EXPECT_NEAR(calc_frequencies(m.calc_stiffness(), M, fixed)[0] / exact, 1, 5e-4);
      }
    }
    // The axial terms of one bar: the mean of lumped and consistent, or consistent.
    const double mass = 0.5 * 0.3 * 2 / 16, h = m.calc_mass(MassKind::Consistent)(0, 0) / mass;
    EXPECT_NEAR(h, on ? 1.0 / 3 : 5.0 / 12, 1e-12);
  }
}

}  // namespace
}  // namespace bough::fe::test
