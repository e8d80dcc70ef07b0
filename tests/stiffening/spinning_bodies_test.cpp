/// What spin does to whole bodies: the propeller moment of blades, a satellite's mass on a lever.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "stiffening/reduce.hpp"
#include "tests/stiffening/all_kinds.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

constexpr int kWz2 = static_cast<int>(InertialLoad::wz2);

records::FlexBody reduce(const std::string& text, int num_modes) {
  Diagnostics diagnostics;
  const auto deck = test::read_deck(text, diagnostics);
  records::BodySpec spec;
  spec.num_modes = num_modes;
  return stiffening::reduce(deck, spec, {}, diagnostics).body;
}

/// Stiffness per Ω² of the modes of a body held on a hub that spins about z.
MatrixXd calc_spin_stiffness(const records::FlexBody& body) {
  const auto n = body.num_modes();
  MatrixXd K = body.kg_inertial[kWz2];
  for (int j = 0; j < n; ++j)
    for (int k = 0; k < n; ++k)
      K(j, k) -= body.exact.gamma4[static_cast<std::size_t>(j)][static_cast<std::size_t>(k)](2, 2);
  return K;
}

constexpr double kChord = 4e-6, kThick = 1e-6;  // ∫y², ∫z²

/// A blade of CBEAM along x; free to turn about x at its root on a spring, or clamped.
std::string make_blade(bool is_clamped, bool is_lumped) {
  std::string text = "SOL 103\nCEND\nSPC = 1\nBEGIN BULK\nPARAM,COUPMASS," + std::string(is_lumped ? "-1" : "1") +
                     "\nMAT1,1,70.+9,,.3,2700.\nPBEAM,1,1,2.-3,4.-6,1.-6,,3.-7\nSPC1,1," +
                     (is_clamped ? "123456" : "12356") + ",1\n" + (is_clamped ? "" : "CELAS2,99,20.,1,4\n");
  for (int i = 1; i <= 17; ++i) {
    text += "GRID," + std::to_string(i) + ",," + std::to_string(0.5 + 0.1 * (i - 1)) + ",0.,0.\n";
    if (i > 1)
      text += "CBEAM," + std::to_string(i) + ",1," + std::to_string(i - 1) + "," + std::to_string(i) + ",0.,1.,0.\n";
  }
  return text;
}

/// Of the first mode that turns the tip about x most.
double calc_torsion_slope(const std::string& text) {
  const auto body = reduce(text, 8);
  const MatrixXd K = calc_spin_stiffness(body);
  for (int j = 0; j < body.num_modes(); ++j) {
    const auto tip = body.phi.back().col(j);
    if (std::abs(tip[3]) > 10 * tip.head<3>().norm()) return K(j, j) / body.modal_mass(j, j);
  }
  ADD_FAILURE() << "no torsion";
  return 0;
}

// ω² = ω0² + Ω² (E_chord - E_thick) / (E_chord + E_thick) of a blade stiff in itself (J. Houbolt & G. Brooks, NACA Rep.
// 1346, 1958).
TEST(SpinningBodies, PropellerMomentOfABlade) {
  const double expected = (kChord - kThick) / (kChord + kThick);
  for (const bool is_lumped : {true, false})
    EXPECT_NEAR(calc_torsion_slope(make_blade(false, is_lumped)) / expected, 1, 5e-3) << is_lumped;
}

// Clamped, the tension T = ½ρAΩ² (R² - x²) adds ∫T r² θ'² / ∫ρ I_p θ², θ = sin(πs/2L).
TEST(SpinningBodies, TorsionOfAClampedBlade) {
  double tension = 0, mass = 0;
  const double L = 1.6, x0 = 0.5;
  for (int i = 0; i < 2000; ++i) {
    const double s = L * (i + 0.5) / 2000, c = std::cos(std::numbers::pi * s / (2 * L)), R = x0 + L, x = x0 + s;
    tension += 0.5 * (R * R - x * x) * std::pow(std::numbers::pi / (2 * L) * c, 2);
    mass += 1 - c * c;
  }
  const double expected = (kChord - kThick) / (kChord + kThick) + tension / mass;
  for (const bool is_lumped : {true, false})
    EXPECT_NEAR(calc_torsion_slope(make_blade(true, is_lumped)) / expected, 1, 5e-3) << is_lumped;
}

/// A panel from the rim at x = 2 inwards, with a mass on a lever on its free edge.
std::string make_panel(const std::string& lever) {
  std::string text = "SOL 103\nCEND\nSPC = 1\nBEGIN BULK\nMAT1,1,70.+9,,.3,2700.\nPSHELL,1,1,.004,1,,1\n";
  const auto id = [](int i, int j) { return std::to_string(1 + i + 9 * j); };
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 9; ++i) {
      text += "GRID," + id(i, j) + ",," + std::to_string(2 - 0.125 * i) + "," + std::to_string(0.2 * (j - 1)) + ",0.\n";
      if (i > 0 && j > 0)
        text += "CQUAD4," + id(i, j) + ",1," + id(i, j - 1) + "," + id(i - 1, j - 1) + "," + id(i - 1, j) + "," +
                id(i, j) + "\n";
    }
  return text + "SPC1,1,123456,1,10,19\nGRID,50,,.7,.1,.15\nCONM2,50,50,,4.,.0,.05,-.04\n,.02,,.03,,,.04\n" + lever;
}

double calc_boundary(const std::string& lever) {
  const auto body = reduce(make_panel(lever), 14);
  // K - Ω² S is singular first at the largest eigenvalue of S against K.
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(-calc_spin_stiffness(body), body.modal_stiffness);
  return 1 / std::sqrt(solver.eigenvalues().maxCoeff());
}

TEST(SpinningBodies, BoundaryOfAMassOnALever) {
  const double bars = calc_boundary(
      "PBAR,2,3,1.-2,1.-4,1.-4,1.-4\nMAT1,3,7.+12,,.3,0.\nCBAR,60,2,9,18,0.,0.,1.\nCBAR,61,2,18,27,0.,0.,1.\n"
      "CBAR,62,2,18,50,0.,0.,1.\n");
  const double links = calc_boundary("RBE2,60,50,123456,9,18,27\n");
  RecordProperty("links_over_bars", std::to_string(links / bars));
  EXPECT_NEAR(links / bars, 1, 1e-3);
  // The mass as an offset of the edge's middle grid.
  const double chain = calc_boundary("RBE2,60,18,123456,9,27\nRBE2,61,18,123456,50\n");
  EXPECT_NEAR(chain / links, 1, 1e-6);
}

}  // namespace
}  // namespace bough
