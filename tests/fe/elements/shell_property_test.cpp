/// PSHELL, PCOMP and the fields of the shell cards, each against another way to say the same.
#include <cmath>

#include "small_model.hpp"

namespace bough::fe::test {
namespace {

constexpr double kE = 3, kNu = 0.3, kT = 0.2;
const std::vector<Vector3d> kCorners = {{0, 0, 0}, {1.2, 0.1, 0}, {1.1, 0.9, 0}, {-0.1, 1.1, 0}};

/// CQUAD4 1 of PSHELL 1 and MAT1 1, not made yet.
SmallModel make_quad() {
  SmallModel m;
  records::Mat1 material;
  material.id = 1, material.E = kE, material.nu = kNu, material.G = kE / 2 / (1 + kNu), material.rho = 0.8;
  m.deck.mat1.push_back(material);
  records::Pshell p;
  p.id = 1, p.mid1 = p.mid2 = p.mid3 = 1, p.t = kT;
  m.deck.pshell.push_back(p);
  records::ShellElement e;
  e.id = e.pid = 1, e.card = "CQUAD4";
  for (int i = 1; i <= 4; ++i) {
    m.nodes.add_grid(i, kCorners[static_cast<std::size_t>(i - 1)]);
    e.grids.push_back(i);
  }
  m.deck.shells.push_back(e);
  return m;
}

double calc_distance(const MatrixXd& a, const MatrixXd& b) { return (a - b).norm() / b.norm(); }

Eigen::Matrix3d make_law() {
  const double c = kE / (1 - kNu * kNu);
  return (Eigen::Matrix3d() << c, kNu * c, 0, kNu * c, c, 0, 0, 0, kE / 2 / (1 + kNu)).finished();
}

VectorXd calc_forces(const SmallModel& m, const VectorXd& u) {
  VectorXd force(m.elements[0]->stress_state()->num_internal_forces());
  m.elements[0]->stress_state()->calc_internal_forces(u, force);
  return force;
}

/// LAM = SMEAR is the PSHELL with MID1 = MID2 of the mean of the plies, without MID3 and MID4; LAM = SMCORE has half of
/// the faces on each side of the core.
TEST(ShellProperty, SmearedLaminates) {
  const double E1 = 4, E2 = 0.4, nu = 0.3, G12 = 0.2, c = 1 - nu * nu * E2 / E1;
  const auto make = [&](records::Layup layup, std::vector<records::Ply> plies, double z0) {
    SmallModel m = make_quad();
    records::Mat8 fibre;
    fibre.id = 5, fibre.E1 = E1, fibre.E2 = E2, fibre.nu12 = nu, fibre.G12 = G12, fibre.rho = 1.5;
    fibre.G1z = fibre.G2z = 0.1;
    m.deck.mat8.push_back(fibre);
    records::Pcomp p;
    p.id = 2, p.layup = layup, p.plies = std::move(plies), p.z0 = z0;
    m.deck.pcomp.push_back(p);
    m.deck.shells[0].pid = 2;
    m.make();
    return m;
  };
  const auto is_warned = [](const SmallModel& m) {
    Diagnostics d;
    make_elements(m.deck, m.nodes, d);
    return d.has("fe.smeared-offset");
  };
  SmallModel mean = make_quad();
  records::Mat2 law;
  law.id = 4, law.rho = 1.5;
  const double Q11 = (E1 + E2) / (2 * c), Q12 = nu * E2 / c;
  law.G << Q11, Q12, 0, Q12, Q11, 0, 0, 0, G12;
  mean.deck.mat2.push_back(law);
  auto& p = mean.deck.pshell[0];
  p.mid1 = p.mid2 = 4, p.mid3 = 0;
  mean.make();
  const auto smeared = records::Layup::Smeared, core = records::Layup::SmearedCore, stacked = records::Layup::Stacked;
  for (const auto& plies : {std::vector<records::Ply>{{5, 0.1, 0}, {5, 0.1, 90}}, {{5, 0.1, 90}, {5, 0.1, 0}}}) {
    const SmallModel m = make(smeared, plies, -0.1);
    EXPECT_LT(calc_distance(m.calc_stiffness(), mean.calc_stiffness()), 1e-12);
    EXPECT_LT(calc_distance(m.calc_mass(MassKind::Consistent), mean.calc_mass(MassKind::Consistent)), 1e-12);
    EXPECT_FALSE(is_warned(m));
  }
  const SmallModel off = make(smeared, {{5, 0.1, 0}, {5, 0.1, 90}}, 0);
  EXPECT_LT(calc_distance(off.calc_stiffness(), mean.calc_stiffness()), 1e-12);
  EXPECT_TRUE(is_warned(off));
  for (const double z0 : {-0.1, 0.3})
    EXPECT_LT(calc_distance(make(core, {{1, 0.02, 0}, {1, 0.03, 30}, {5, 0.15, 20}}, z0).calc_stiffness(),
                            make(stacked, {{1, 0.025, 0}, {5, 0.15, 20}, {1, 0.025, 0}}, z0).calc_stiffness()),
              1e-12);
}

/// A plate whose middle is e above the grids, said by MID4, by Z0 of a laminate, and by ZOFFS: the first two are one
/// element; a pure bending about the grids stretches all three by the same N = Q t e κ.
TEST(ShellProperty, CouplingByMid4IsAnEccentricPlate) {
  const double e = 0.07;
  SmallModel by_mid4 = make_quad(), by_plies = make_quad(), by_offset = make_quad();
  auto& p = by_mid4.deck.pshell[0];
  p.bending_ratio = 1 + 12 * e * e / (kT * kT);
  p.mid4 = 4;
  records::Mat2 coupling;
  coupling.id = 4, coupling.G = -e / kT * make_law();  // B = -T² G4
  by_mid4.deck.mat2.push_back(coupling);
  by_mid4.make();
  records::Pcomp laminate;
  laminate.id = 2, laminate.z0 = e - kT / 2, laminate.plies = {{1, kT, 0}};
  by_plies.deck.pcomp.push_back(laminate);
  by_plies.deck.shells[0].pid = 2;
  by_plies.make();
  by_offset.deck.shells[0].z_offset = e;
  by_offset.make();
  EXPECT_LT(calc_distance(by_mid4.calc_stiffness(), by_plies.calc_stiffness()), 1e-13);
  VectorXd u = VectorXd::Zero(24);  // w = -½ κ x²
  const double kappa = 0.01;
  for (int i = 0; i < 4; ++i) {
    const double x = kCorners[static_cast<std::size_t>(i)].x();
    u[6 * i + 2] = -0.5 * kappa * x * x;
    u[6 * i + 4] = kappa * x;
  }
  const VectorXd a = calc_forces(by_mid4, u), b = calc_forces(by_offset, u);
  const Vector3d first = a.head<3>();
  // |N| has the invariants of Q t e κ in any axes.
  EXPECT_NEAR(first[0] + first[1], kE / (1 - kNu) * kT * e * kappa, 1e-13);
  for (int q = 0; q < 4; ++q) EXPECT_LT((a - b).segment<3>(8 * q).norm(), 1e-12 * first.norm()) << q;
}

TEST(ShellProperty, CornerThicknessesAndTflag) {
  SmallModel uniform = make_quad();
  uniform.make();
  SmallModel own = make_quad();
  own.deck.pshell[0].t.reset();
  own.deck.shells[0].t = {0.1, 0.2, 0.3, 0.2};
  own.make();
  SmallModel relative = make_quad();
  relative.deck.shells[0].t = {0.5, 1.0, 1.5, 1.0};
  relative.deck.shells[0].relative_thickness = true;
  relative.make();
  SmallModel blank = make_quad();  // a blank corner has the property's, with TFLAG or without
  blank.deck.shells[0].t = {0.1, std::nan(""), 0.3, std::nan("")};
  blank.make();
  SmallModel blank_relative = make_quad();
  blank_relative.deck.shells[0].t = {0.5, std::nan(""), 1.5, 1.0};
  blank_relative.deck.shells[0].relative_thickness = true;
  blank_relative.make();
  for (const auto* m : {&own, &relative, &blank, &blank_relative}) {
    EXPECT_LT(calc_distance(m->calc_stiffness(), uniform.calc_stiffness()), 1e-13);
    EXPECT_LT(calc_distance(m->calc_mass(MassKind::Lumped), uniform.calc_mass(MassKind::Lumped)), 1e-13);
  }
}

TEST(ShellProperty, LaminateOfMembraneOrBendingOnly) {
  const auto make = [](bool membrane, bool bending) {
    SmallModel m = make_quad();
    records::Pcomp p;
    p.id = 2, p.z0 = -kT / 2, p.plies = {{1, kT, 0}}, p.membrane = membrane, p.bending = bending;
    m.deck.pcomp.push_back(p);
    m.deck.shells[0].pid = 2;
    m.deck.params.push_back({"K6ROT", "0.", {}});
    m.make();
    return m.calc_stiffness();
  };
  const MatrixXd both = make(true, true), membrane = make(true, false), bending = make(false, true);
  EXPECT_LT(calc_distance(membrane + bending, both), 1e-13);
  for (int i = 0; i < 24; i += 6) {
    EXPECT_EQ(membrane.middleRows<3>(i + 2).norm(), 0);  // w θx θy
    EXPECT_EQ(bending.middleRows<2>(i).norm(), 0);       // u v
    EXPECT_GT(membrane(i, i), 0);
    EXPECT_GT(bending(i + 2, i + 2), 0);
  }
}

/// MID2 = -1: stresses of a body that cannot strain along z, by λ and G; no bending.
TEST(ShellProperty, PlaneStrain) {
  SmallModel m = make_quad();
  m.deck.pshell[0].mid2 = -1, m.deck.pshell[0].mid3 = 0;
  m.deck.shells[0].grids = {1, 2, 3, 4};
  m.make();
  VectorXd u = VectorXd::Zero(24);
  for (int i = 0; i < 4; ++i) u[6 * i] = 0.01 * kCorners[static_cast<std::size_t>(i)].x();  // ε_xx alone
  const VectorXd f = calc_forces(m, u);
  const double lambda = kE * kNu / (1 + kNu) / (1 - 2 * kNu), G = kE / 2 / (1 + kNu);
  EXPECT_NEAR(f[0] + f[1], 0.01 * kT * (2 * lambda + 2 * G), 1e-14);
  EXPECT_NEAR(f[0] * f[1] - f[2] * f[2], 1e-4 * kT * kT * (lambda + 2 * G) * lambda, 1e-15);
  EXPECT_EQ(f.segment<5>(3).norm(), 0);
}

/// Two plates at ten degrees: within PARAM,SNORM they share the normals of the fold, beyond it each is on its own.
TEST(ShellProperty, SnormSharesNormalsWithinItsAngle) {
  const auto make = [](const char* snorm, std::vector<int> which) {
    SmallModel m = make_quad();
    m.deck.shells.clear();
    const double c = std::cos(0.1745), s = std::sin(0.1745);
    m.nodes.add_grid(5, Vector3d(0, 0, 0));
    m.nodes.add_grid(6, Vector3d(1, 0, 0));
    m.nodes.add_grid(7, Vector3d(1, 1, 0));
    m.nodes.add_grid(8, Vector3d(0, 1, 0));
    m.nodes.add_grid(9, Vector3d(1 + c, 0, s));
    m.nodes.add_grid(10, Vector3d(1 + c, 1, s));
    for (int k : which) {
      records::ShellElement e;
      e.id = k + 1, e.pid = 1, e.card = "CQUAD4";
      e.grids = k == 0 ? std::vector<int>{5, 6, 7, 8} : std::vector<int>{6, 9, 10, 7};
      m.deck.shells.push_back(e);
    }
    m.deck.params.push_back({"SNORM", snorm, {}});
    m.make();
    return m.calc_stiffness();
  };
  const MatrixXd alone = make("20.", {0}) + make("20.", {1});
  EXPECT_LT(calc_distance(make("4.", {0, 1}), alone), 1e-14);
  EXPECT_LT(calc_distance(make("0.", {0, 1}), alone), 1e-14);
  EXPECT_GT(calc_distance(make("20.", {0, 1}), alone), 1e-3);
}

TEST(ShellProperty, ErrorsAreReported) {
  SmallModel m = make_quad();
  m.nodes.add_system(7, Vector3d::Zero(), Eigen::AngleAxisd(std::acos(-1.0) / 2, Vector3d::UnitY()).toRotationMatrix());
  m.deck.shells[0].mcid = 7;  // its x-axis is along -z: no matter for an isotropic shell
  EXPECT_EQ(count_messages(m, "fe.bad-material-axes"), 0);
  m.deck.shells[0].mcid.reset();
  m.deck.pshell[0].mid2 = -1;
  EXPECT_EQ(count_messages(m, "fe.bad-property"), 0);
  m.deck.mat1[0].nu = 0.5;
  EXPECT_EQ(count_messages(m, "fe.bad-property"), 1);
}

/// A MAT1 has no axes; a MAT8 has. CQUAD8 asks at every point but speaks once, with its field.
TEST(ShellProperty, MaterialAxesThatAreNone) {
  for (const bool curved : {false, true}) {
    SmallModel m = make_quad();
    m.nodes.add_system(7, Vector3d::Zero(),
                       Eigen::AngleAxisd(std::acos(-1.0) / 2, Vector3d::UnitY()).toRotationMatrix());
    if (curved) {
      m.deck.shells[0].card = "CQUAD8";
      m.deck.shells[0].midsides = {0, 0, 0, 0};
    }
    m.make();
    const MatrixXd K = m.calc_stiffness();
    m.elements.clear();
    m.deck.shells[0].mcid = 7;
    m.make();
    EXPECT_LT((m.calc_stiffness() - K).norm(), 1e-12 * K.norm());

    records::Mat8 ply;
    ply.id = 8, ply.E1 = 3, ply.E2 = 1, ply.G12 = 0.5;
    m.deck.mat8.push_back(ply);
    m.deck.pshell[0].mid1 = m.deck.pshell[0].mid2 = 8;
    EXPECT_EQ(count_messages(m, "fe.bad-material-axes"), 1) << curved;
    m.deck.shells[0].mcid = 99;
    Diagnostics d;
    make_elements(m.deck, m.nodes, d);
    ASSERT_EQ(d.items().size(), 1u) << curved;
    EXPECT_EQ(d.items()[0].id, "fe.missing-coordinates");
    EXPECT_NE(d.items()[0].what.find("has MCID 99"), std::string::npos);
  }
}

}  // namespace
}  // namespace bough::fe::test
