/// Uniform beams against closed forms: frequencies, Euler loads, lateral-torsional and torque buckling.
#include <numbers>

#include "small_model.hpp"

namespace bough::fe::test {
namespace {

constexpr double kPi = std::numbers::pi;

records::Pbar make_section(double A, double I1, double I2, double J) {
  records::Pbar section;
  section.A = A, section.I1 = I1, section.I2 = I2, section.J = J;
  return section;
}

ChainOptions make_options(int num_elements, double length, double E, double G, const records::Pbar& section) {
  ChainOptions options;
  options.num_elements = num_elements, options.length = length, options.E = E, options.G = G;
  options.section = section;
  return options;
}

const std::vector<int> kClampedFirst{0, 1, 2, 3, 4, 5};

/// The cantilever of report 4.1.4.1 with 40 CBAR.
TEST(BeamFrequencies, ReportCantilever) {
  for (MassKind kind : {MassKind::Lumped, MassKind::Consistent}) {
    ChainOptions options;
    options.num_elements = 40;
    options.length = 8;
    options.E = 6.895e10;
    options.G = options.E / 2.6;
    options.rho = 1.6154 / (8 * 7.2986e-5);
    options.section = make_section(7.2986e-5, 8.2181e-9, 8.2181e-9, 2 * 8.2181e-9);
    options.R = make_rotation(3);
    const SmallModel model = make_bar_chain(options);
    const VectorXd omega = calc_frequencies(model.calc_stiffness(), model.calc_mass(kind), kClampedFirst);
    const double tolerance = kind == MassKind::Lumped ? 5e-3 : 2e-4;
    EXPECT_NEAR(omega[0] / 2.91022, 1, tolerance);
    EXPECT_NEAR(omega[1] / 2.91022, 1, tolerance);
    EXPECT_NEAR(omega[2] / 18.2380, 1, tolerance);
    EXPECT_NEAR(omega[4] / 51.067, 1, tolerance);
  }
}

struct EulerCase {
  const char* name;
  std::vector<int> fixed_a, fixed_b;  ///< components 0..5 in element axes (the beam lies along basic x)
  double factor;                      ///< P L² / (π² E I)
};

TEST(BeamBuckling, EulerLoads) {
  const double clamped_pinned = 4.493409457909064 * 4.493409457909064 / (kPi * kPi);  // tan x = x
  const EulerCase cases[] = {{"cantilever", {0, 1, 2, 3, 4, 5}, {}, 0.25},
                             {"pinned", {0, 1, 2, 3}, {1, 2}, 1},
                             {"clamped-clamped", {0, 1, 2, 3, 4, 5}, {1, 2, 3, 4, 5}, 4},
                             {"clamped-pinned", {0, 1, 2, 3, 4, 5}, {1, 2}, clamped_pinned}};
  ChainOptions options = make_options(20, 3, 7e10, 2.7e10, make_section(1e-3, 2e-8, 5e-8, 1e-8));
  const SmallModel model = make_bar_chain(options);
  const MatrixXd K = model.calc_stiffness();
  const int n = static_cast<int>(K.rows());
  for (const EulerCase& c : cases) {
    std::vector<int> fixed = c.fixed_a;
    for (int i : c.fixed_b) fixed.push_back(n - 6 + i);
    VectorXd f = VectorXd::Zero(n);
    f[n - 6] = -1;
    const MatrixXd K_G = model.calc_geometric_stiffness(solve_static(K, f, fixed));
    const double P = c.factor * kPi * kPi * options.E * 2e-8 / 9;
    EXPECT_NEAR(calc_load_factor(K, K_G, fixed) / P, 1, 1e-4) << c.name;
  }
}

/// I_strong / I_weak = 1e5: the bending before buckling does not change the load. Strong bending in plane 1 or 2.
ChainOptions make_strip(unsigned seed, int plane) {
  ChainOptions options;
  options.num_elements = 32;
  options.length = 2;
  options.E = 7e10;
  options.G = 2.7e10;
  options.R = make_rotation(seed);
  options.section = plane == 1 ? make_section(1e-2, 1e-4, 1e-9, 3e-9) : make_section(1e-2, 1e-9, 1e-4, 3e-9);
  return options;
}

/// Timoshenko & Gere, Theory of Elastic Stability, art. 6.3: 4.013 √(EI GJ) / L².
TEST(BeamBuckling, LateralCantileverEndLoad) {
  for (int plane : {1, 2}) {
    const ChainOptions options = make_strip(static_cast<unsigned>(plane), plane);
    const SmallModel model = make_bar_chain(options);
    const MatrixXd K = model.calc_stiffness();
    const int n = static_cast<int>(K.rows());
    for (double sign : {1.0, -1.0}) {
      VectorXd f = VectorXd::Zero(n);
      f.segment<3>(n - 6) = sign * options.R.col(plane);
      const MatrixXd K_G = model.calc_geometric_stiffness(solve_static(K, f, kClampedFirst));
      const double P = 4.012599 * std::sqrt(options.E * 1e-9 * options.G * 3e-9) / 4;
      EXPECT_NEAR(calc_load_factor(K, K_G, kClampedFirst) / P, 1, 1e-3);
    }
  }
}

/// Simply supported in bending and torsion, equal end moments: π √(EI GJ) / L.
TEST(BeamBuckling, LateralUniformMoment) {
  for (int plane : {1, 2}) {
    const ChainOptions options = make_strip(5, plane);
    const SmallModel model = make_bar_chain(options);
    // The supports are along the element axes: turn the matrices there.
    const MatrixXd K0 = model.calc_stiffness();
    const int n = static_cast<int>(K0.rows());
    MatrixXd T = MatrixXd::Zero(n, n);
    for (int i = 0; i < n; i += 3) T.block<3, 3>(i, i) = options.R;
    const MatrixXd K = T.transpose() * K0 * T;
    const std::vector<int> fixed{0, 1, 2, 3, n - 5, n - 4, n - 3};
    VectorXd f = VectorXd::Zero(n);
    const int about = plane == 1 ? 5 : 4;
    f[about] = -1;
    f[n - 6 + about] = 1;
    const MatrixXd K_G = T.transpose() * model.calc_geometric_stiffness(T * solve_static(K, f, fixed)) * T;
    EXPECT_NEAR(calc_load_factor(K, K_G, fixed) / (kPi * std::sqrt(options.E * 1e-9 * options.G * 3e-9) / 2), 1, 1e-3);
  }
}

/// Shaft clamped at both ends, one free to twist and to move axially: T = 2 x 4.4934 EI / L, tan x = x (Greenhill's
/// problem with clamped ends; Ziegler, Principles of Structural Stability, art. 3.4).
TEST(BeamBuckling, TorqueClampedShaft) {
  ChainOptions options = make_options(40, 1.5, 2e11, 8e10, make_section(1e-4, 8e-10, 8e-10, 1.6e-9));
  const SmallModel model = make_bar_chain(options);
  const MatrixXd K = model.calc_stiffness();
  const int n = static_cast<int>(K.rows());
  const std::vector<int> fixed{0, 1, 2, 3, 4, 5, n - 5, n - 4, n - 2, n - 1};
  VectorXd f = VectorXd::Zero(n);
  f[n - 3] = 1;
  const MatrixXd K_G = model.calc_geometric_stiffness(solve_static(K, f, fixed));
  EXPECT_NEAR(calc_load_factor(K, K_G, fixed) / (2 * 4.493409457909064 * options.E * 8e-10 / options.length), 1, 1e-3);
}

/// Shear: P_E / (1 + P_E / (k G A)) (Engesser; Timoshenko & Gere art. 2.17), pinned ends. A shear-soft element is
/// linear in its deflection, so the error falls as h²: extrapolated from two meshes.
TEST(BeamBuckling, EngesserColumn) {
  ChainOptions options;
  options.E = 7e10;
  options.G = 2.7e10;
  options.section = make_section(1e-2, 3e-5, 9e-5, 4e-5);
  options.section.k1 = 0.4;
  const double P_E = kPi * kPi * options.E * 3e-5, exact = P_E / (1 + P_E / (0.4 * options.G * 1e-2));
  double load[2];
  for (int mesh = 0; mesh < 2; ++mesh) {
    options.num_elements = 10 << mesh;
    const SmallModel model = make_bar_chain(options);
    const MatrixXd K = model.calc_stiffness();
    const int n = static_cast<int>(K.rows());
    const std::vector<int> fixed{0, 1, 2, 3, n - 5, n - 4};
    VectorXd f = VectorXd::Zero(n);
    f[n - 6] = -1;
    load[mesh] = calc_load_factor(K, model.calc_geometric_stiffness(solve_static(K, f, fixed)), fixed);
  }
  EXPECT_NEAR((load[0] - exact) / (load[1] - exact), 4, 0.1);
  EXPECT_NEAR((4 * load[1] - load[0]) / 3 / exact, 1, 1e-5);
}

SmallModel make_cbeam_chain(const records::Pbeam& property, int num_elements, double length) {
  SmallModel model;
  model.deck.mat1.push_back({1, 7e10, 2.7e10, 0.3, 2700, 0, 0, 0, 0, 0, 0, {}});
  model.deck.pbeam.push_back(property);
  model.deck.pbeam.back().id = model.deck.pbeam.back().mid = 1;
  for (int k = 0; k <= num_elements; ++k) model.nodes.add_grid(k + 1, Vector3d(length * k / num_elements, 0, 0));
  for (int k = 1; k <= num_elements; ++k) {
    records::BeamElement e;
    e.id = k, e.pid = 1, e.ga = k, e.gb = k + 1, e.is_cbeam = true, e.v = Vector3d(0, 1, 0);
    model.deck.beams.push_back(e);
  }
  model.make();
  return model;
}

records::Pbeam make_pbeam(double A, double I1, double I2, double J) {
  records::Pbeam p;
  p.k1 = p.k2 = 0;
  p.stations.resize(2);
  p.stations[1].x_over_L = 1;
  for (auto& s : p.stations) s.A = A, s.I1 = I1, s.I2 = I2, s.J = J;
  return p;
}

/// Simply supported column through the centroid, shear centre at distance y0: (P - P_w)(P - P_t) r0² = P² y0² with
/// P_t = GJ / r0² and no warping stiffness (Timoshenko & Gere art. 5.4). Tests Wagner's term and its coupling.
TEST(BeamBuckling, FlexuralTorsional) {
  const double A = 1e-3, I1 = 4e-6, I2 = 3e-7, J = 2e-9, y0 = 0.04, L = 2;
  records::Pbeam p = make_pbeam(A, I1, I2, J);
  p.n1_a = p.n1_b = y0;
  const SmallModel model = make_cbeam_chain(p, 32, L);
  const MatrixXd K = model.calc_stiffness();
  const int n = static_cast<int>(K.rows());
  const std::vector<int> fixed{0, 1, 2, 3, n - 5, n - 4, n - 3};
  VectorXd f = VectorXd::Zero(n);
  f[n - 6] = -1;
  f[n - 1] = y0;  // the force acts at the centroid, y0 above the shear centre
  f[5] = -y0;
  const double P_w = kPi * kPi * 7e10 * I2 / (L * L), r2 = y0 * y0 + (I1 + I2) / A, P_t = 2.7e10 * J / r2;
  const double a = 1 - y0 * y0 / r2, b = P_w + P_t;
  const double P = (b - std::sqrt(b * b - 4 * a * P_w * P_t)) / (2 * a);
  const VectorXd u = solve_static(K, f, fixed);
  EXPECT_LT(u.segment(1, n - 1).cwiseAbs().minCoeff(), 1e-12);
  EXPECT_NEAR(calc_load_factor(K, model.calc_geometric_stiffness(u), fixed) / P, 1, 1e-3);
}

/// Closed form of the uniform Timoshenko beam (Przemieniecki 1968, eq. 5.116).
TEST(BeamStiffness, UniformClosedForm) {
  const double E = 5, G = 2, A = 0.3, I1 = 0.02, I2 = 0.05, J = 0.04, L = 1.7, k1 = 0.7, k2 = 0.4;
  ChainOptions options = make_options(1, L, E, G, make_section(A, I1, I2, J));
  options.section.k1 = k1, options.section.k2 = k2;
  const MatrixXd K = make_bar_chain(options).calc_stiffness();
  MatrixXd expected = MatrixXd::Zero(12, 12);
  const auto add = [&](int i, int j, double k) {
    expected(i, i) += k, expected(j, j) += k, expected(i, j) -= k, expected(j, i) -= k;
  };
  add(0, 6, E * A / L);
  add(3, 9, G * J / L);
  const auto add_plane = [&](std::array<int, 4> dofs, double I, double k, double sign) {
    const double phi = 12 * E * I / (k * G * A * L * L), c = E * I / (L * L * L * (1 + phi));
    Eigen::Matrix4d B;
    B << 12, 6 * L, -12, 6 * L, 6 * L, (4 + phi) * L * L, -6 * L, (2 - phi) * L * L, -12, -6 * L, 12, -6 * L, 6 * L,
        (2 - phi) * L * L, -6 * L, (4 + phi) * L * L;
    const Eigen::Vector4d s(1, sign, 1, sign);
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        expected(dofs[static_cast<std::size_t>(i)], dofs[static_cast<std::size_t>(j)]) += c * s[i] * B(i, j) * s[j];
  };
  add_plane({1, 5, 7, 11}, I1, k1, 1);
  add_plane({2, 4, 8, 10}, I2, k2, -1);
  EXPECT_LT((K - expected).norm(), 1e-13 * expected.norm());
}

/// Unsymmetric cantilever: deflection F L³/3E [I]⁻¹, I12 turning the load out of its plane.
TEST(BeamStiffness, UnsymmetricBending) {
  ChainOptions options = make_options(3, 2, 5, 2, make_section(0.3, 0.02, 0.05, 0.04));
  options.section.I12 = 0.015;
  const SmallModel model = make_bar_chain(options);
  VectorXd f = VectorXd::Zero(24);
  f[19] = 1;
  const VectorXd u = solve_static(model.calc_stiffness(), f, kClampedFirst);
  const double det = 0.02 * 0.05 - 0.015 * 0.015, c = 8.0 / (3 * 5 * det);
  EXPECT_NEAR(u[19], c * 0.05, 1e-12);
  EXPECT_NEAR(u[20], -c * 0.015, 1e-12);
}

/// I linear along the beam, one element: tip deflection ∫ (L-x)²/EI + shear ∫ 1/kGA, both by logarithms.
TEST(BeamStiffness, TaperedCantilever) {
  records::Pbeam p = make_pbeam(4e-3, 8e-6, 6e-6, 1e-6);
  p.stations[1].A = 1e-3, p.stations[1].I1 = 1e-6, p.stations[1].I2 = 3e-6, p.stations[1].J = 2e-7;
  p.k1 = 0.8;
  const double L = 1.5, E = 7e10, G = 2.7e10;
  const SmallModel model = make_cbeam_chain(p, 1, L);
  VectorXd f = VectorXd::Zero(12);
  f[7] = 1;
  const VectorXd u = solve_static(model.calc_stiffness(), f, kClampedFirst);
  // ∫0..1 t² / (a + b t) dt from the tip, a = I at the tip
  const double a = 1e-6, b = 7e-6;
  const double bending = L * L * L / E * (1 / (2 * b) - a / (b * b) + a * a / (b * b * b) * std::log((a + b) / a));
  const double shear = L / (0.8 * G) * std::log(4.0) / (4e-3 - 1e-3);
  EXPECT_NEAR(u[7] / (bending + shear), 1, 1e-12);
  f.setZero();
  f[9] = 1;
  EXPECT_NEAR(solve_static(model.calc_stiffness(), f, kClampedFirst)[9] / (L / G * std::log(5.0) / 8e-7), 1, 1e-12);
}

/// The same taper described by more stations is the same beam: stiffness, mass, geometric stiffness.
TEST(BeamStiffness, ExtraStationsOnALineChangeNothing) {
  records::Pbeam p = make_pbeam(4e-3, 8e-6, 6e-6, 1e-6);
  p.stations[1].A = 2e-3, p.stations[1].I1 = 3e-6, p.stations[1].I2 = 4e-6, p.stations[1].J = 7e-7;
  records::Pbeam q = p;
  records::PbeamStation middle = p.stations.front();
  middle.x_over_L = 0.3;
  middle.A = 3.4e-3, middle.I1 = 6.5e-6, middle.I2 = 5.4e-6, middle.J = 9.1e-7;
  q.stations.insert(q.stations.begin() + 1, middle);
  const SmallModel a = make_cbeam_chain(p, 1, 1.5), b = make_cbeam_chain(q, 1, 1.5);
  VectorXd u(12);
  u << 0.1, 0.2, 0.3, -0.1, 0.05, 0.02, 0.3, -0.2, 0.1, 0.04, 0.03, -0.06;
  const auto expect_same = [](const MatrixXd& x, const MatrixXd& y) { EXPECT_LT((x - y).norm(), 1e-11 * x.norm()); };
  expect_same(a.calc_stiffness(), b.calc_stiffness());
  expect_same(a.calc_mass(MassKind::Consistent), b.calc_mass(MassKind::Consistent));
  expect_same(a.calc_mass(MassKind::Lumped), b.calc_mass(MassKind::Lumped));
  expect_same(a.calc_geometric_stiffness(u), b.calc_geometric_stiffness(u));
}

/// Patch: two elements with their middle grid condensed are one element.
TEST(BeamStiffness, TwoElementsAreOne) {
  ChainOptions options = make_options(1, 2, 5, 2, make_section(0.3, 0.02, 0.05, 0.04));
  options.R = make_rotation(9);
  options.section.k1 = 0.5, options.section.k2 = 0.6;
  const MatrixXd one = make_bar_chain(options).calc_stiffness();
  options.num_elements = 2;
  const MatrixXd two = make_bar_chain(options).calc_stiffness();
  const std::vector<int> ends{0, 1, 2, 3, 4, 5, 12, 13, 14, 15, 16, 17};
  const MatrixXd K_em = two(ends, Eigen::seqN(6, 6));
  const MatrixXd condensed = pick(two, ends) - K_em * two.block(6, 6, 6, 6).ldlt().solve(K_em.transpose());
  EXPECT_LT((condensed - one).norm(), 1e-12 * one.norm());
}

/// Released moments: 3 EI / L³ for a hinge at B, EA alone with both ends hinged; a release of nothing left is harmless.
TEST(BeamStiffness, PinFlags) {
  ChainOptions options = make_options(1, 2, 5, 2, make_section(0.3, 0.02, 0.05, 0.04));
  SmallModel model = make_bar_chain(options);
  model.deck.beams[0].pin_b = 1u << 5;
  model.make();
  MatrixXd K = model.calc_stiffness();
  EXPECT_NEAR(K(1, 1), 3 * 5 * 0.02 / 8, 1e-14);
  EXPECT_NEAR(K.row(11).norm(), 0, 1e-14);
  EXPECT_NEAR(K(2, 2), 12 * 5 * 0.05 / 8, 1e-14);
  model.deck.beams[0].pin_a = model.deck.beams[0].pin_b = 0b111000;  // torsion released twice
  model.make();
  K = model.calc_stiffness();
  MatrixXd truss = MatrixXd::Zero(12, 12);
  truss(0, 0) = truss(6, 6) = 5 * 0.3 / 2;
  truss(0, 6) = truss(6, 0) = -5 * 0.3 / 2;
  EXPECT_LT((K - truss).norm(), 1e-13);
  // Hinged bar under tension: the string stiffness N / L and nothing else.
  VectorXd u = VectorXd::Zero(12);
  u[6] = 1;
  const double N = 5 * 0.3 / 2;
  MatrixXd string = MatrixXd::Zero(12, 12);
  for (int i : {1, 2}) {
    string(i, i) = string(6 + i, 6 + i) = N / 2;
    string(i, 6 + i) = string(6 + i, i) = -N / 2;
  }
  EXPECT_LT((model.calc_geometric_stiffness(u).topLeftCorner(3, 3) - string.topLeftCorner(3, 3)).norm(), 1e-13);
}

/// Internal forces of a tip-loaded cantilever; N, V, T, and the moments at both ends, with their signs.
TEST(BeamForces, TipLoads) {
  ChainOptions options = make_options(1, 2, 5, 2, make_section(0.3, 0.02, 0.05, 0.04));
  options.R = make_rotation(6);
  const SmallModel model = make_bar_chain(options);
  const Vector3d load(3, -4, 5), moment(0.6, 0.7, -0.8);
  VectorXd f = VectorXd::Zero(12);
  f.segment<3>(6) = options.R * load;
  f.segment<3>(9) = options.R * moment;
  const VectorXd u = solve_static(model.calc_stiffness(), f, kClampedFirst);
  VectorXd force(8), expected(8);
  model.elements[0]->stress_state()->calc_internal_forces(u, force);
  expected << 3, -4, 5, 0.6, 0.7 - 5 * 2, -0.8 - 4 * 2, 0.7, -0.8;
  EXPECT_LT((force - expected).norm(), 1e-12);
}

/// Plane 1 only: every dof but v and θz fixed, and those of `supports`.
std::vector<int> fix_other_planes(int n, std::vector<int> supports) {
  for (int i = 0; i < n; ++i)
    if (i % 6 != 1 && i % 6 != 5) supports.push_back(i);
  return supports;
}

/// Consistent mass: the error of the cantilever's frequencies falls as h⁴.
TEST(BeamFrequencies, ConsistentMassConvergesAsH4) {
  const double beta[] = {1.875104068711961, 4.694091132974175};
  double error[2][2];
  for (int mesh = 0; mesh < 2; ++mesh) {
    ChainOptions options;
    options.num_elements = 4 << mesh;
    options.section = make_section(1, 1, 2, 1);
    const SmallModel model = make_bar_chain(options);
    const MatrixXd K = model.calc_stiffness();
    const VectorXd omega = calc_frequencies(K, model.calc_mass(MassKind::Consistent),
                                            fix_other_planes(static_cast<int>(K.rows()), {1, 5}));
    for (int mode = 0; mode < 2; ++mode) error[mesh][mode] = omega[mode] / (beta[mode] * beta[mode]) - 1;
  }
  for (int mode = 0; mode < 2; ++mode) EXPECT_NEAR(std::log2(error[0][mode] / error[1][mode]), 4, 0.15) << mode;
}

/// Timoshenko beam, simply supported, with rotary inertia (CBEAM consistent): the exact frequency equation of each
/// half-wave (Timoshenko 1921): ω⁴ ρI/(kGA) - ω² (1 + k²(r² + E r²/(kG))) + EI k⁴/(ρA) = 0 with wave number k.
TEST(BeamFrequencies, TimoshenkoWithRotaryInertia) {
  const double A = 4, I = 4.0 / 3, E = 200e9, rho = 8000, k = 5.0 / 6, G = E / 2.6, L = 10;
  records::Pbeam p = make_pbeam(A, I, 2 * I, 2);
  p.k1 = k;
  VectorXd omega[2];
  for (int mesh = 0; mesh < 2; ++mesh) {
    SmallModel model = make_cbeam_chain(p, 20 << mesh, L);
    model.deck.mat1[0] = {1, E, G, 0.3, rho, 0, 0, 0, 0, 0, 0, {}};
    model.make();
    const MatrixXd K = model.calc_stiffness();
    const int n = static_cast<int>(K.rows());
    omega[mesh] = calc_frequencies(K, model.calc_mass(MassKind::Consistent), fix_other_planes(n, {1, n - 5}));
  }
  const double targets[] = {42.609, 147.786, 282.36};  // deep beam of NAFEMS FV5, κ = 5/6, in Hz
  for (int mode = 1; mode <= 3; ++mode) {
    const double q = mode * kPi / L, r2 = I / A;
    const double a = rho * r2 / (k * G), b = 1 + q * q * r2 * (1 + E / (k * G)), c = E * r2 * q * q * q * q / rho;
    const double exact = std::sqrt((b - std::sqrt(b * b - 4 * a * c)) / (2 * a));
    EXPECT_NEAR(exact / (2 * kPi) / targets[mode - 1], 1, 3e-5);
    // h² in a beam as deep as this (shear-soft elements), extrapolated
    EXPECT_NEAR((4 * omega[1][mode - 1] - omega[0][mode - 1]) / 3 / exact, 1, 2e-5) << mode;
    EXPECT_NEAR(omega[1][mode - 1] / exact, 1, 1e-3) << mode;
  }
}

/// Lumped masses by Nastran: CBAR translations only, CBEAM with torsional inertia ρ (I1 + I2) L / 2 and NSI at each
/// end.
TEST(BeamMass, LumpedNastranForm) {
  ChainOptions options;
  options.num_elements = 1;
  options.length = 2, options.rho = 3;
  options.section = make_section(0.3, 0.02, 0.05, 0.04);
  options.section.nsm = 0.1;
  VectorXd diagonal(6);
  diagonal << 1, 1, 1, 0, 0, 0;
  MatrixXd expected = MatrixXd::Zero(12, 12);
  expected.diagonal() << diagonal, diagonal;
  EXPECT_LT((make_bar_chain(options).calc_mass(MassKind::Lumped) - expected).norm(), 1e-14);

  records::Pbeam p = make_pbeam(0.3, 0.02, 0.05, 0.04);
  p.nsi_a = p.nsi_b = 0.4;
  const double m = 2700 * 0.3, Jx = 2700 * 0.07 + 0.4;
  diagonal << m, m, m, Jx, 0, 0;
  expected.diagonal() << diagonal, diagonal;
  EXPECT_LT((make_cbeam_chain(p, 1, 2).calc_mass(MassKind::Lumped) - expected).norm(), 1e-11);
}

/// Beams along x with rho = 3, a section of A = 0.5.
ChainOptions make_heavy_options(int num_elements, double length) {
  ChainOptions options;
  options.num_elements = num_elements, options.length = length, options.rho = 3;
  options.section = make_section(0.5, 0.02, 0.05, 0.04);
  return options;
}

/// Nastran's coupled CBAR: cubic bending without rotary inertia, axial 5/12 and 1/12, no torsion.
TEST(BeamMass, ConsistentNastranBar) {
  const MatrixXd M = make_bar_chain(make_heavy_options(1, 2)).calc_mass(MassKind::Consistent);
  const double m = 3, L = 2;
  EXPECT_NEAR(M(0, 0), m * 5 / 12, 1e-14);
  EXPECT_NEAR(M(0, 6), m / 12, 1e-14);
  EXPECT_NEAR(M(1, 1), m * 156 / 420, 1e-14);
  EXPECT_NEAR(M(1, 5), m * 22 * L / 420, 1e-14);
  EXPECT_NEAR(M(1, 11), -m * 13 * L / 420, 1e-14);
  EXPECT_NEAR(M(4, 10), -m * 3 * L * L / 420, 1e-14);
  EXPECT_NEAR(M(2, 4), -m * 22 * L / 420, 1e-14);
  EXPECT_EQ(M(3, 3), 0);
}

/// Two equal beams take theirs from the field that they share; one alone, and skew ones, from the same formula.
TEST(BeamMass, OfASharedFieldIsThatOfItsOwn) {
  ChainOptions options = make_heavy_options(2, 2.6);
  const MatrixXd chain = make_bar_chain(options).calc_mass(MassKind::Consistent);
  options.R = make_rotation(3);
  const MatrixXd skew_chain = make_bar_chain(options).calc_mass(MassKind::Consistent);
  options.R.setIdentity();
  options.num_elements = 1, options.length = 1.3;
  const MatrixXd one = make_bar_chain(options).calc_mass(MassKind::Consistent);
  MatrixXd expected = MatrixXd::Zero(18, 18), T = MatrixXd::Zero(18, 18);
  expected.topLeftCorner<12, 12>() += one, expected.bottomRightCorner<12, 12>() += one;
  EXPECT_LT((chain - expected).norm(), 1e-15 * expected.norm());
  for (int i = 0; i < 18; i += 3) T.block<3, 3>(i, i) = make_rotation(3);
  EXPECT_LT((skew_chain - T * expected * T.transpose()).norm(), 1e-14 * expected.norm());
}

}  // namespace
}  // namespace bough::fe::test
