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
  ChainOptions options;
  options.num_elements = 20;
  options.length = 3;
  options.E = 7e10;
  options.G = 2.7e10;
  options.section = make_section(1e-3, 2e-8, 5e-8, 1e-8);
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

/// I_strong / I_weak = 1e5: the bending before buckling does not change the load. Strong bending in plane 1.
ChainOptions make_strip(unsigned seed) {
  ChainOptions options;
  options.num_elements = 32;
  options.length = 2;
  options.E = 7e10;
  options.G = 2.7e10;
  options.R = make_rotation(seed);
  options.section = make_section(1e-2, 1e-4, 1e-9, 3e-9);
  return options;
}

/// Timoshenko & Gere, Theory of Elastic Stability, art. 6.3: 4.013 √(EI GJ) / L².
TEST(BeamBuckling, LateralCantileverEndLoad) {
  for (unsigned seed : {1u, 2u}) {
    const ChainOptions options = make_strip(seed);
    const SmallModel model = make_bar_chain(options);
    const MatrixXd K = model.calc_stiffness();
    const int n = static_cast<int>(K.rows());
    for (double sign : {1.0, -1.0}) {
      VectorXd f = VectorXd::Zero(n);
      f.segment<3>(n - 6) = sign * options.R.col(1);
      const MatrixXd K_G = model.calc_geometric_stiffness(solve_static(K, f, kClampedFirst));
      const double P = 4.012599 * std::sqrt(options.E * 1e-9 * options.G * 3e-9) / 4;
      EXPECT_NEAR(calc_load_factor(K, K_G, kClampedFirst) / P, 1, 1e-3);
    }
  }
}

/// Simply supported in bending and torsion, equal end moments: π √(EI GJ) / L.
TEST(BeamBuckling, LateralUniformMoment) {
  const ChainOptions options = make_strip(5);
  const SmallModel model = make_bar_chain(options);
  // The supports are along the element axes: turn the matrices there.
  const MatrixXd K0 = model.calc_stiffness();
  const int n = static_cast<int>(K0.rows());
  MatrixXd T = MatrixXd::Zero(n, n);
  for (int i = 0; i < n; i += 3) T.block<3, 3>(i, i) = options.R;
  const MatrixXd K = T.transpose() * K0 * T;
  const std::vector<int> fixed{0, 1, 2, 3, n - 5, n - 4, n - 3};
  VectorXd f = VectorXd::Zero(n);
  f[5] = -1;
  f[n - 1] = 1;
  const MatrixXd K_G = T.transpose() * model.calc_geometric_stiffness(T * solve_static(K, f, fixed)) * T;
  EXPECT_NEAR(calc_load_factor(K, K_G, fixed) / (kPi * std::sqrt(options.E * 1e-9 * options.G * 3e-9) / 2), 1, 1e-3);
}

/// Shaft clamped at both ends (one free to twist and to move axially): T = 8.9868 EI / L (Ziegler, Principles of
/// Structural Stability: tan(x/2) = x/2 with x = T L / (2 EI) ... 2 x 4.4934).
TEST(BeamBuckling, TorqueClampedShaft) {
  ChainOptions options;
  options.num_elements = 40;
  options.length = 1.5;
  options.E = 2e11;
  options.G = 8e10;
  options.section = make_section(1e-4, 8e-10, 8e-10, 1.6e-9);
  const SmallModel model = make_bar_chain(options);
  const MatrixXd K = model.calc_stiffness();
  const int n = static_cast<int>(K.rows());
  const std::vector<int> fixed{0, 1, 2, 3, 4, 5, n - 5, n - 4, n - 2, n - 1};
  VectorXd f = VectorXd::Zero(n);
  f[n - 3] = 1;
  const MatrixXd K_G = model.calc_geometric_stiffness(solve_static(K, f, fixed));
  EXPECT_NEAR(calc_load_factor(K, K_G, fixed) / (2 * 4.493409457909064 * options.E * 8e-10 / options.length), 1, 1e-3);
}

}  // namespace
}  // namespace bough::fe::test
