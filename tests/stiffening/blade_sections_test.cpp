/// One blade of bars and of shells: the propeller moment, and flap with torsion where mass is off the elastic axis.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "stiffening/reduce.hpp"
#include "tests/stiffening/all_kinds.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

// A strip along x in the plane of rotation, spun about z, clamped at x = kRoot.
constexpr double kRoot = 0.5, kLength = 1.6, kChord = 0.1, kThick = 0.004, kRho = 2700;
constexpr double kLine = kRho * kChord * kThick, kOffset = 0.25 * kChord;  // a line of mass beside the axis
constexpr int kTip = 1000;

std::string write(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9e", x);
  return text;
}

std::string start_deck(const std::string& selection, bool is_lumped) {
  return "SOL 103\nCEND\nSPC = 1\n" + selection + "BEGIN BULK\nPARAM,COUPMASS," + (is_lumped ? "-1" : "1") +
         "\nMAT1,1,70.+9,,0.,2700.\n";
}

/// CBEAMs without shear flexibility; J is that of a strip of shell, which does not see its edges.
std::string make_beams(bool is_lumped, bool has_line) {
  constexpr int kNum = 32;
  const double J = kChord * std::pow(kThick, 3) / 3;
  const std::string m1 = has_line ? write(kOffset) : "0.";
  std::string text = start_deck("", is_lumped) + "SPC1,1,123456,1\n";
  text += "PBEAM*,1,1," + write(kChord * kThick) + "," + write(kThick * std::pow(kChord, 3) / 12) + "\n*," +
          write(kChord * std::pow(kThick, 3) / 12) + ",," + write(J) + "," + (has_line ? write(kLine) : "0.") +
          "\n*,,,,\n*,,,,\n*,0.,0.,,\n*,,,,\n*," + m1 + ",0.," + m1 + ",0.\n*,,,,\n";
  for (int i = 0; i <= kNum; ++i) {
    const int id = i == kNum ? kTip : i + 1;
    text += "GRID*," + std::to_string(id) + ",," + write(kRoot + kLength * i / kNum) + ",0.\n*,0.\n";
    if (i > 0)
      text += "CBEAM," + std::to_string(i) + ",1," + std::to_string(i) + "," + std::to_string(id) + ",0.,1.,0.\n";
  }
  return text;
}

/// Four CQUAD4 over the chord; the root may warp: its rotations θy are antisymmetric.
std::string make_shells(bool has_line) {
  constexpr int kNum = 48, kAcross = 4;
  std::string text = start_deck("MPC = 8\n", false) + "PSHELL,1,1,.004,1,,1\n";
  const auto id = [](int i, int j) {
    return std::to_string(i == kNum && j == kAcross / 2 ? kTip : 1 + j + (kAcross + 1) * i);
  };
  for (int i = 0; i <= kNum; ++i)
    for (int j = 0; j <= kAcross; ++j) {
      const double y = kChord * (static_cast<double>(j) / kAcross - 0.5);
      text += "GRID*," + id(i, j) + ",," + write(kRoot + kLength * i / kNum) + "," + write(y) + "\n*,0.\n";
      if (i > 0 && j > 0)
        text += "CQUAD4," + id(i, j) + ",1," + id(i - 1, j - 1) + "," + id(i, j - 1) + "," + id(i, j) + "," +
                id(i - 1, j) + "\n";
      if (has_line && y == kOffset)
        text += "CONM2*," + std::to_string(2000 + i) + "," + id(i, j) + ",," +
                write(kLine * kLength / kNum * (i == 0 || i == kNum ? 0.5 : 1)) + "\n*,\n";
    }
  for (int j = 0; j <= kAcross; ++j) text += "SPC1,1,12346," + id(0, j) + "\n";
  text += "SPC1,1,5," + id(0, kAcross / 2) + "\n";
  for (int j = 0; j < kAcross / 2; ++j) text += "MPC,8," + id(0, j) + ",5,1.," + id(0, kAcross - j) + ",5,1.\n";
  return text;
}

/// Motion out of the plane of rotation at a speed: squares of frequencies and, per mode, flap and chord times twist of
/// the tip's axis, of length one.
struct Motion {
  std::vector<double> lambda;
  std::vector<Eigen::Vector2d> tip;
};

struct Blade {
  explicit Blade(const std::string& text) {
    Diagnostics diagnostics;
    const auto deck = test::read_deck(text, diagnostics);
    records::BodySpec spec;
    spec.num_modes = 14;
    spec.output_nodes = {kTip};
    body = stiffening::reduce(deck, spec, {}, diagnostics).body;
    stiffness = body.kg_inertial[static_cast<std::size_t>(records::InertialLoad::wz2)];
    for (std::size_t j = 0; j < 14; ++j)
      for (std::size_t k = 0; k < 14; ++k)
        stiffness(static_cast<int>(j), static_cast<int>(k)) -= body.exact.gamma4[j][k](2, 2);
  }

  /// Per Ω², of the first mode that turns the tip: λ grows by that much.
  double calc_torsion_slope() const {
    for (int j = 0; j < body.num_modes(); ++j) {
      const auto tip = body.phi[0].col(j);
      if (std::abs(tip[3]) > 10 * tip.head<3>().norm()) return stiffness(j, j) / body.modal_mass(j, j);
    }
    ADD_FAILURE() << "no torsion";
    return 0;
  }

  Motion calc_motion(double omega) const {
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(body.modal_stiffness + omega * omega * stiffness,
                                                                    body.modal_mass);
    Motion motion;
    for (int j = 0; j < body.num_modes(); ++j) {
      const VectorXd tip = body.phi[0] * solver.eigenvectors().col(j);
      if (tip.segment<2>(2).norm() < std::abs(tip[1])) continue;
      motion.lambda.push_back(solver.eigenvalues()[j]);
      motion.tip.push_back(Eigen::Vector2d(tip[2], kChord * tip[3]).normalized());
    }
    return motion;
  }

  records::FlexBody body;
  MatrixXd stiffness;  ///< per Ω²
};

// Tension and propeller moment: ω² of the first torsion grows by (E_chord - E_thick) / (E_chord + E_thick) Ω² and
// ∫T r² θ'² / ∫ρ I_p θ², θ = sin(πs/2L), T = ½ρAΩ² (R² - x²) (J. Houbolt & G. Brooks, NACA Rep. 1346, 1958).
TEST(BladeSections, PropellerMomentOfBeamsAndShells) {
  double tension = 0, mass = 0;
  for (int i = 0; i < 2000; ++i) {
    const double s = kLength * (i + 0.5) / 2000, c = std::cos(std::numbers::pi * s / (2 * kLength));
    const double R = kRoot + kLength, x = kRoot + s;
    tension += 0.5 * (R * R - x * x) * std::pow(std::numbers::pi / (2 * kLength) * c, 2);
    mass += 1 - c * c;
  }
  const double slender = std::pow(kThick / kChord, 2);
  const double expected = (1 - slender) / (1 + slender) + tension / mass;
  const double shells = Blade(make_shells(false)).calc_torsion_slope();
  RecordProperty("shells", std::to_string(shells / expected));
  EXPECT_NEAR(shells / expected, 1, 0.02);
  for (const bool is_lumped : {true, false}) {
    const double beams = Blade(make_beams(is_lumped, false)).calc_torsion_slope();
    RecordProperty(is_lumped ? "lumped_beams" : "beams", std::to_string(beams / expected));
    EXPECT_NEAR(beams / expected, 1, 0.005) << is_lumped;
    EXPECT_NEAR(beams / shells, 1, 0.02) << is_lumped;
  }
}

// A line of mass at a quarter of the chord: flap and torsion are coupled by S, at rest and at twice the first flap.
TEST(BladeSections, FlapTorsionOfAMassOffTheElasticAxis) {
  const Blade shells(make_shells(true));
  double most = 0, off = 0;
  for (const bool is_lumped : {true, false}) {
    const Blade beams(make_beams(is_lumped, true));
    for (const double omega : {0., 15., 60.}) {
      const auto expected = shells.calc_motion(omega), found = beams.calc_motion(omega);
      ASSERT_GE(std::min(expected.lambda.size(), found.lambda.size()), 5u);
      for (std::size_t j = 0; j < 5; ++j) {
        off = std::max(off, std::abs(found.lambda[j] / expected.lambda[j] - 1));
        EXPECT_NEAR(found.lambda[j] / expected.lambda[j], 1, 0.02) << omega << " mode " << j + 1 << is_lumped;
        const double sign = found.tip[j].dot(expected.tip[j]) > 0 ? 1 : -1;
        EXPECT_LT((found.tip[j] - sign * expected.tip[j]).norm(), 0.02) << omega << " mode " << j + 1 << is_lumped;
        most = std::max(most, std::min(expected.tip[j].cwiseAbs().x(), expected.tip[j].cwiseAbs().y()));
      }
    }
  }
  RecordProperty("largest_error_of_squares", std::to_string(off));
  EXPECT_GT(most, 0.2);  // both in one mode
}

}  // namespace
}  // namespace bough
