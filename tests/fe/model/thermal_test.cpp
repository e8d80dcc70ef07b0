/// \file Temperatures as loads against closed forms: free expansion, held bars, bimetal, gradients.
#include <gtest/gtest.h>

#include <cmath>

#include "fe/statics/static_case.hpp"
#include "text_model.hpp"

namespace bough::fe {
namespace {

struct Heated : test::LoadedModel {
  using LoadedModel::LoadedModel;
  StaticLoad make_load() { return calc_static_load(*model, deck, -1, diagnostics); }
  records::StaticSubcase solve() {
    const auto load = make_load();
    diagnostics.throw_if_errors();
    const StaticSolver solver(*model, assemble_stiffness(*model, DofSet::Free));
    auto result = solve_static_case(*model, solver, load);
    result.elements =
        calc_element_forces(*model, result.displacement, deck, model->subcase().load, diagnostics, load.initial);
    return result;
  }
};

std::string write_grid(int id, const Vector3d& x) {
  char line[160];
  std::snprintf(line, sizeof line, "GRID,%d,,%.15g,%.15g,%.15g\n", id, x[0], x[1], x[2]);
  return line;
}

// ---- Free expansion: the field ε x leaves no force, no internal force and no energy, whatever the element.

struct FreeCase {
  const char* name;
  std::string cards;
  double alpha_x = 1.2e-5, alpha_y = 1.2e-5, alpha_z = 1.2e-5;
};

/// Grids 1..8: a distorted brick; 9..16: points between; 21..24: a distorted quadrilateral in a tilted plane, 25..28
/// the middles of its sides.
std::string write_grids() {
  const Vector3d brick[8] = {{0, 0, 0},  {1.1, .1, 0},  {1, 1.2, .1},   {-.1, .9, 0},
                             {.1, 0, 1}, {1, -.1, 1.1}, {1.2, 1.1, .9}, {0, 1, 1.2}};
  std::string text;
  for (int i = 0; i < 8; ++i) text += write_grid(i + 1, brick[i]);
  text += write_grid(9, {.55, .05, .02}) + write_grid(10, {1.05, .65, .05});
  const auto lift = [](double x, double y) { return Vector3d(x, y, 0.3 * x - 0.2 * y); };
  const Vector3d quad[4] = {lift(0, 0), lift(1.3, .1), lift(1.1, 1.2), lift(-.2, .8)};
  for (int i = 0; i < 4; ++i)
    text += write_grid(21 + i, quad[i]) + write_grid(25 + i, (quad[i] + quad[(i + 1) % 4]) / 2);
  text += write_grid(31, (quad[0] + quad[2]) / 2);
  return text;
}

TEST(ThermalLoads, FreeExpansionLeavesNoStress) {
  const std::string iso = "MAT1,1,7.+10,,.3,2700.,1.2-5,20.\n", shell = "PSHELL,1,1,.05,1,,1\n" + iso;
  const FreeCase cases[] = {
      {"CROD", "CROD,1,1,1,7\nPROD,1,1,1.-3,1.-6\n" + iso},
      {"CTUBE", "CTUBE,1,1,1,7\nPTUBE,1,1,.1,.01,,.2\n" + iso},
      {"CBAR", "CBAR,1,1,1,7,0.,0.,1.\nPBAR,1,1,1.-3,1.-6,2.-6,1.-6,,,+\n+,\n+,.8,.7,5.-7\n" + iso},
      {"CBEAM",
       "CBEAM,1,1,1,7,0.,0.,1.\nPBEAM,1,1,1.-3,1.-6,2.-6,,1.-6,,+\n+,,,,,,,,,+\n+,YES,1.,5.-4,4.-7,8.-7,,4.-7\n" + iso},
      {"CQUAD4", "CQUAD4,1,1,21,22,23,24,30.\n" + shell},
      {"CQUADR", "CQUADR,1,1,21,22,23,24\n" + shell},
      {"CTRIA3", "CTRIA3,1,1,21,22,23\n" + shell},
      {"CTRIAR", "CTRIAR,1,1,21,22,23\n" + shell},
      {"CQUAD8", "CQUAD8,1,1,21,22,23,24,25,26,+\n+,27\n" + shell},
      {"CTRIA6", "CTRIA6,1,1,21,22,23,25,26,31\n" + shell},
      {"CHEXA", "CHEXA,1,1,1,2,3,4,5,6,+\n+,7,8\nPSOLID,1,1\n" + iso},
      {"CHEXA-10", "CHEXA,1,1,1,2,3,4,5,6,+\n+,7,8,9,10\nPSOLID,1,1\n" + iso},
      {"CPENTA", "CPENTA,1,1,1,2,3,5,6,7\nPSOLID,1,1\n" + iso},
      {"CTETRA", "CTETRA,1,1,1,2,3,5\nPSOLID,1,1\n" + iso},
      {"CTETRA-5", "CTETRA,1,1,1,2,3,5,9\nPSOLID,1,1\n" + iso},
      {"MAT9",
       "CHEXA,1,1,1,2,3,4,5,6,+\n+,7,8\nPSOLID,1,1\nMAT9,1,5.+10,1.+10,1.+10,,,,4.+10,+\n+,1.+10,,,,3.+10,,,,+\n"
       "+,1.+10,,,2.+10,,1.5+10,,1.-5,+\n+,2.-5,3.-5,,,,20.\n",
       1e-5, 2e-5, 3e-5},
  };
  // The second time TREF is left to TEMPERATURE(INITIAL), which says the same.
  for (const bool has_tref : {true, false})
    for (const auto& c : cases) {
      SCOPED_TRACE(c.name);
      std::string cards = c.cards;
      if (!has_tref) cards.replace(cards.rfind("20.\n"), 3, "");
      Heated h(std::string(has_tref ? "" : "TEMP(INIT) = 6\n") +
               "TEMP(LOAD) = 5\nBEGIN BULK\nTEMPD,5,120.\nTEMPD,6,20.\n" + write_grids() + cards);
      const auto load = h.make_load();
      ASSERT_EQ(h.diagnostics.num_errors(), 0);
      ASSERT_EQ(load.initial.of.size(), 1u);
      VectorXd u = VectorXd::Zero(h.model->num_gdofs());
      const Vector3d strain = 100 * Vector3d(c.alpha_x, c.alpha_y, c.alpha_z);
      for (const auto& node : h.model->nodes()) u.segment<3>(node.first_gdof) = strain.cwiseProduct(node.x);
      const VectorXd K_u = calc_stiffness_times(*h.model, u);
      EXPECT_GT(load.F.norm(), 0);
      EXPECT_LT((K_u - load.F).norm(), 1e-10 * load.F.norm());
      const auto forces = calc_element_forces(*h.model, u, h.deck, 0, h.diagnostics, load.initial);
      ASSERT_EQ(forces.size(), 1u);
      const double scale = load.initial.of.begin()->second.force.norm();
      EXPECT_GT(scale, 0);
      EXPECT_LT(forces[0].force.norm(), 1e-10 * scale);
      EXPECT_GT(load.initial.of.begin()->second.energy, 0);
      EXPECT_LT(std::abs(forces[0].strain_energy[0]), 1e-10 * load.initial.of.begin()->second.energy);
    }
}

// ---- Bars: EA = 7e6, EI1 = 700, EI2 = 350, α = 1.2e-5, L = 2.

const std::string kBar =
    "SPC = 1\nTEMP(LOAD) = 5\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nCBAR,1,1,1,2,0.,1.,0.\n"
    "PBAR,1,1,1.-4,1.-8,5.-9,1.-8\nMAT1,1,7.+10,,.3,2700.,1.2-5,20.\nSPC1,1,123456,1\n";
constexpr double kEA = 7e6, kEI1 = 700, kEI2 = 350, kAlpha = 1.2e-5, kL = 2;

TEST(ThermalLoads, BarFreeAndHeld) {
  auto free = Heated(kBar + "TEMP,5,1,50.,2,150.\n").solve();
  EXPECT_NEAR(free.displacement[6], kAlpha * 80 * kL, 1e-15);
  EXPECT_NEAR(free.elements[0].force(0, 0), 0, 1e-8);
  EXPECT_NEAR(free.strain_energy, 0, 1e-9);
  auto held = Heated(kBar +
                     "SPC1,1,123456,2\nGRID,3,,0.,1.,0.\nGRID,4,,0.,2.,0.\nCELAS2,9,1.,3,1,4,1\nSPC1,1,23456,3,4\n"
                     "SPC1,1,1,3\nTEMPD,5,120.\n")
                  .solve();
  EXPECT_NEAR(held.elements[0].force(0, 0), -kEA * kAlpha * 100, 1e-6);
  EXPECT_NEAR(held.reaction[0], kEA * kAlpha * 100, 1e-6);
  EXPECT_NEAR(held.reaction[6], -kEA * kAlpha * 100, 1e-6);
  EXPECT_NEAR(held.strain_energy, 0.5 * kEA * std::pow(kAlpha * 100, 2) * kL, 1e-9);
  // Nastran's OLOAD has the loads of the temperatures.
  EXPECT_NEAR(held.load[6], kEA * kAlpha * 100, 1e-6);
}

// MSC Nastran takes them where TREF is blank; they were a note, and strains counted from zero.
TEST(ThermalLoads, InitialTemperatures) {
  const std::string cards = "TEMP,5,1,50.,2,150.\nTEMP,6,1,30.,2,90.\n";
  std::string open = kBar;
  open.replace(open.find(",20.\n"), 4, "");
  EXPECT_NEAR(Heated("TEMP(INITIAL) = 6\n" + open + cards).solve().displacement[6], kAlpha * 40 * kL, 1e-15);
  EXPECT_NEAR(Heated(open + cards).solve().displacement[6], kAlpha * 100 * kL, 1e-15);
  EXPECT_NEAR(Heated("TEMP(INITIAL) = 6\n" + kBar + cards).solve().displacement[6], kAlpha * 80 * kL, 1e-15);
  // Gradients are differences too.
  auto gradients = Heated("TEMP(INITIAL) = 6\n" + open + "TEMPRB,5,1,20.,20.,50.,50.\nTEMPRB,6,1,20.,20.,20.,20.\n");
  EXPECT_NEAR(gradients.solve().displacement[7], -kAlpha * 30 * kL * kL / 2, 1e-15);
  Heated missing("TEMP(INITIAL) = 6\n" + open + "TEMPD,5,50.\nTEMP,6,1,30.\n");
  missing.make_load();
  EXPECT_TRUE(missing.diagnostics.has("fe.missing-temperature"));
  Heated none("TEMP(INITIAL) = 7\n" + open + "TEMPD,5,50.\n");
  none.make_load();
  EXPECT_TRUE(none.diagnostics.has("fe.missing-load"));
  // TREF of a laminate is its own, zero where it is blank.
  for (const char* tref : {"", "20."}) {
    Heated plate(
        std::string(
            "TEMP(INITIAL) = 6\nTEMP(LOAD) = 5\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0."
            "\nCTRIA3,1,1,1,2,3\nMAT1,1,7.+10,,.3,,1.-5\nTEMPD,5,50.\nTEMPD,6,20.\nPCOMP,1,,,,,") +
        tref + "\n,1,.1\n");
    EXPECT_EQ(plate.diagnostics.has("fe.laminate-tref"), *tref == 0);
  }
}

TEST(ThermalLoads, BarWithGradients) {
  // Hotter on the +y and the +z side: bends to -y and -z with α T' and without a moment.
  const auto free = Heated(kBar + "TEMPRB,5,1,20.,20.,50.,50.,30.,30.\n").solve();
  EXPECT_NEAR(free.displacement[7], -kAlpha * 50 * kL * kL / 2, 1e-15);
  EXPECT_NEAR(free.displacement[8], -kAlpha * 30 * kL * kL / 2, 1e-15);
  EXPECT_NEAR(free.displacement[11], -kAlpha * 50 * kL, 1e-15);
  EXPECT_NEAR(free.displacement[10], kAlpha * 30 * kL, 1e-15);
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(free.elements[0].force(0, i), 0, 1e-9);
  // A gradient that grows from nothing: κ = α T' x / L.
  const auto growing = Heated(kBar + "TEMPRB,5,1,20.,20.,0.,50.,0.,0.\n").solve();
  EXPECT_NEAR(growing.displacement[7], -kAlpha * 50 * kL * kL / 6, 1e-15);
  EXPECT_NEAR(growing.displacement[11], -kAlpha * 50 * kL / 2, 1e-15);
  // Held at both ends: M = EI α T' all along.
  const std::string spring = "GRID,3,,0.,1.,0.\nGRID,4,,0.,2.,0.\nCELAS2,9,1.,3,1,4,1\nSPC1,1,23456,3,4\nSPC1,1,1,3\n";
  const auto held = Heated(kBar + spring + "SPC1,1,123456,2\nTEMPRB,5,1,20.,20.,50.,50.,30.,30.\n").solve();
  EXPECT_NEAR(held.elements[0].force(0, 5), kEI1 * kAlpha * 50, 1e-9);
  EXPECT_NEAR(held.elements[0].force(0, 7), kEI1 * kAlpha * 50, 1e-9);
  EXPECT_NEAR(held.elements[0].force(0, 4), -kEI2 * kAlpha * 30, 1e-9);
  EXPECT_NEAR(held.reaction[5], -kEI1 * kAlpha * 50, 1e-9);
}

TEST(ThermalLoads, ReleasedEndTakesNoMoment) {
  // Clamped and pinned: the clamp carries 3/2 EI α T'.
  std::string bulk = kBar;
  bulk.replace(bulk.find("CBAR,1,1,1,2,0.,1.,0."), 21, "CBAR,1,1,1,2,0.,1.,0.,,+\n+,,6");
  bulk += "GRID,3,,0.,1.,0.\nGRID,4,,0.,2.,0.\nCELAS2,9,1.,3,1,4,1\nSPC1,1,23456,3,4\nSPC1,1,1,3\n";
  const auto held = Heated(bulk + "SPC1,1,123456,2\nTEMPRB,5,1,20.,20.,50.,50.,0.,0.\n").solve();
  EXPECT_NEAR(held.elements[0].force(0, 5), 1.5 * kEI1 * kAlpha * 50, 1e-9);
  EXPECT_NEAR(held.elements[0].force(0, 7), 0, 1e-9);
  EXPECT_NEAR(held.reaction[5], -1.5 * kEI1 * kAlpha * 50, 1e-9);
  EXPECT_NEAR(held.reaction[11], 0, 1e-9);
  EXPECT_NEAR(held.strain_energy, 0.5 * kEI1 * std::pow(kAlpha * 50, 2) * kL * 0.75, 1e-12);
}

// ---- Plates: a unit square of 2 x 2 elements, held as a rigid body at three corners.

std::string make_square(const std::string& property, const std::string& card = "CQUAD4") {
  std::string text = "SPC = 1\nTEMP(LOAD) = 5\nBEGIN BULK\n" + property;
  for (int i = 0; i < 9; ++i) {
    // The middle is not in the middle.
    const double shift = i == 4 ? 0.07 : 0;
    text += write_grid(i + 1, {0.5 * (i % 3) + shift, 0.5 * (i / 3) - shift, 0});
  }
  int id = 0;
  for (const int corner : {1, 2, 4, 5}) {
    const std::string quad[4] = {std::to_string(corner), std::to_string(corner + 1), std::to_string(corner + 4),
                                 std::to_string(corner + 3)};
    const auto add = [&](std::initializer_list<int> corners) {
      text += card + "," + std::to_string(++id) + ",1";
      for (const int c : corners) text += "," + quad[c];
      text += "\n";
    };
    if (card == "CTRIA3") {
      add({0, 1, 2});
      add({0, 2, 3});
    } else {
      add({0, 1, 2, 3});
    }
  }
  return text + "SPC1,1,123,1\nSPC1,1,23,3\nSPC1,1,3,7\n";
}

TEST(ThermalLoads, BimetalPlateBendsAsTimoshenkoSays) {
  // S. Timoshenko, "Analysis of bi-metal thermostats", J. Opt. Soc. Am. 11 (1925), eq. 4; equal ν: the same both ways.
  const double E1 = 1e11, E2 = 2e11, a1 = 1e-5, a2 = 2e-5, t1 = .002, t2 = .001, m = t1 / t2, n = E1 / E2, h = t1 + t2;
  const double kappa =
      6 * (a2 - a1) * 100 * (1 + m) * (1 + m) / (h * (3 * (1 + m) * (1 + m) + (1 + m * n) * (m * m + 1 / (m * n))));
  for (const char* card : {"CQUAD4", "CTRIA3"}) {
    auto s =
        Heated(make_square("MAT1,1,1.+11,,.3,,1.-5\nMAT1,2,2.+11,,.3,,2.-5\nPCOMP,1,,,,,20.,,,+\n+,1,.002,,,2,.001\n",
                           card) +
               "TEMPD,5,120.\n")
            .solve();
    // The hotter metal is above: it bows upward, w = -κ (x² + y²)/2 less the plane through the corners.
    const double middle = s.displacement[6 * 1 + 2];
    EXPECT_NEAR(middle, kappa / 8, 1e-9 * kappa) << card;
    EXPECT_NEAR(s.strain_energy > 0, true, 0);
    for (Eigen::Index e = 0; e < s.elements[0].force.rows(); ++e)
      for (int i = 0; i < 24; ++i) EXPECT_NEAR(s.elements[0].force(e, i), 0, i % 8 < 3 ? 1e-4 : 1e-7) << card;
  }
}

/// A temperature linear over a rectangle is harmonic: u = α (g (x² - y²)/2 + h x y), v = α (h (y² - x²)/2 + g x y)
/// leaves no stress (Boley & Weiner, Theory of thermal stresses, 3.4). The inner modes of CQUAD4 hold it exactly.
TEST(ThermalLoads, LinearTemperatureLeavesARectangleFree) {
  Heated h(
      "TEMP(LOAD) = 5\nSPC = 1\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,3.,0.,0.\nGRID,3,,3.,2.,0.\nGRID,4,,0.,2.,0.\n"
      "CQUAD4,1,1,1,2,3,4\nPSHELL,1,1,.05,1,,1\nMAT1,1,7.+10,,.3,2700.,1.2-5,20.\nSPC1,1,123,1\nSPC1,1,23,2\n"
      "SPC1,1,3,4\nTEMP,5,1,30.,2,60.,3,100.\nTEMP,5,4,70.\n");
  auto solved = h.solve();
  ASSERT_EQ(solved.elements.size(), 1u);
  const double held = 7e10 / 0.7 * 0.05 * 1.2e-5 * 80;
  EXPECT_LT(solved.elements[0].force.norm(), 1e-9 * held);
  EXPECT_LT(std::abs(solved.strain_energy), 1e-9 * held * 1.2e-5 * 80 * 6);
  // Relative to side 1-2 held: its curvature α h gives v = -α h x²/2 + ω x with v(3) = 0.
  const double g = 10, k = 20, a = 1.2e-5;
  const auto exact = [&](double x, double y) {
    return Vector3d(a * (10 * x + g * (x * x - y * y) / 2 + k * x * y),
                    a * (10 * y + k * (y * y - x * x) / 2 + g * x * y), 0);
  };
  const double turn = -exact(3, 0).y() / 3;
  const Vector3d corner[4] = {{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0}};
  for (int i = 0; i < 4; ++i) {
    const Vector3d& x = corner[i];
    const Vector3d u = exact(x.x(), x.y()) + turn * Vector3d(-x.y(), x.x(), 0);
    EXPECT_LT((solved.displacement.segment<3>(6 * i) - u).norm(), 1e-9 * u.norm() + 1e-15) << i;
  }
}

/// One element of a bimetal cantilever, temperature rising along it: w = κ1 L²/6 when κ = κ1 x/L (the mean gives κ1
/// L²/4).
TEST(ThermalLoads, TemperatureAlongABimetalPlate) {
  for (const char* card : {"CQUAD4,1,1,1,2,3,4\n", "CQUADR,1,1,1,2,3,4\n"}) {
    Heated h(std::string("TEMP(LOAD) = 5\nSPC = 1\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,.2,0.\n"
                         "GRID,4,,0.,.2,0.\nPCOMP,1,,,,,20.\n,1,.01,0.,,2,.01,0.\nMAT1,1,7.+10,,0.,,1.-5\n"
                         "MAT1,2,7.+10,,0.,,3.-5\nSPC1,1,123456,1,4\nTEMP,5,1,20.,4,20.\nTEMP,5,2,120.,3,120.\n") +
             card);
    // Equal layers: κ = (3/2) Δα ΔT / t with t of both (Timoshenko 1925), towards the layer that expands less.
    const double kappa = 1.5 * 2e-5 * 100 / .02;
    EXPECT_NEAR(h.solve().displacement[8] / (-kappa / 6), 1, 1e-6) << card;
  }
}

TEST(ThermalLoads, QuasiIsotropicLaminateExpandsByItsInvariants) {
  // [0/45/-45/90]s: α = (β1 + β2) / (Q11 + Q22 + 2 Q12) with β = Q α of a ply. TREF is the laminate's.
  const double E1 = 2.03e7, E2 = 1.49e6, nu = .29, a1 = .7e-6, a2 = 31.2e-6, c = 1 - nu * nu * E2 / E1;
  const double Q11 = E1 / c, Q22 = E2 / c, Q12 = nu * E2 / c;
  const double alpha = (Q11 * a1 + Q12 * a2 + Q12 * a1 + Q22 * a2) / (Q11 + Q22 + 2 * Q12);
  auto s = Heated(make_square("MAT8,2,2.03+7,1.49+6,.29,7.47+5,1.+15,1.+15,.1,+\n+,.7-6,31.2-6,999.\n"
                              "PCOMP,1,,,,,30.,,SYM,+\n+,2,.125,0.,,2,.125,45.,,+\n+,2,.125,-45.,,2,.125,90.\n") +
                  "TEMPD,5,100.\n")
               .solve();
  EXPECT_NEAR(s.displacement[6 * 2], alpha * 70, 1e-12);
  EXPECT_NEAR(s.displacement[6 * 6 + 1], alpha * 70, 1e-12);
  EXPECT_NEAR(s.displacement[6 * 4 + 2], 0, 1e-15);
  // The plies hold each other: energy stays although the plate is free.
  EXPECT_GT(s.strain_energy, 0);
}

TEST(ThermalLoads, PlateWithAGradient) {
  const std::string iron = "MAT1,1,2.+11,,.3,,1.2-5,20.\nPSHELL,1,1,.01,1,,1\n";
  for (const char* card : {"CQUAD4", "CTRIA3", "CQUADR"}) {
    const std::string gradient = "TEMPP1,5,1,20.,300.,,,,,+\n+,2,THRU,8\n";
    const auto free = Heated(make_square(iron, card) + gradient).solve();
    EXPECT_NEAR(free.displacement[6 * 1 + 2], kAlpha * 300 / 8, 1e-11) << card;
    EXPECT_LT(free.elements[0].force.cwiseAbs().maxCoeff(), 1e-5) << card;
    // Held in rotation all around: M = D (1 + ν) α T'.
    const auto held = Heated(make_square(iron, card) + gradient + "SPC1,1,3456,1,THRU,9\n").solve();
    const double D = 2e11 * 1e-6 / 12 / .91;
    EXPECT_NEAR(held.elements[0].force(0, 3), -D * 1.3 * kAlpha * 300, 1e-6) << card;
    EXPECT_NEAR(held.elements[0].force(0, 4), -D * 1.3 * kAlpha * 300, 1e-6) << card;
  }
}

TEST(ThermalLoads, SolidBendsUnderALinearTemperature) {
  // T = 20 + 300 z in a free brick: ε = α 300 z, w = -α 300 (x² + y²)/2 + α 300 z²/2, and no stress.
  std::string text =
      "SPC = 1\nTEMP(LOAD) = 5\nBEGIN BULK\nMAT1,1,2.+11,,.3,,1.2-5,20.\nPSOLID,1,1\n"
      "CHEXA,1,1,1,2,3,4,5,6,+\n+,7,8\nCHEXA,2,1,2,9,10,3,6,11,+\n+,12,7\n";
  const Vector3d x[12] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1},
                          {1, 1, 1}, {0, 1, 1}, {2, 0, 0}, {2, 1, 0}, {2, 0, 1}, {2, 1, 1}};
  for (int i = 0; i < 12; ++i) {
    text += write_grid(i + 1, x[i]);
    text += "TEMP,5," + std::to_string(i + 1) + "," + (x[i][2] > 0 ? "320." : "20.") + "\n";
  }
  text += "SPC1,1,123,1\nSPC1,1,23,9\nSPC1,1,3,4\nSPC1,1,456,1,THRU,12\n";
  const auto s = Heated(text).solve();
  const double k = kAlpha * 300;
  EXPECT_NEAR(s.displacement[6 * 1 + 2], k * 0.5, 1e-9 * k);                     // grid 2, between 1 and 9
  EXPECT_NEAR(s.displacement[6 * 10] - s.displacement[6 * 4], 2 * k, 1e-9 * k);  // length on top
  EXPECT_LT(s.elements[0].force.cwiseAbs().maxCoeff(), 1e-6 * 2e11 * k);
}

// ---- Which temperature counts, and what is missing.

TEST(ThermalLoads, CardsOfElementsComeBeforeThoseOfGrids) {
  const auto s = Heated(kBar + "TEMP,5,1,999.,2,999.\nTEMPRB,5,1,70.,120.,0.,0.,0.,0.\n").solve();
  EXPECT_NEAR(s.displacement[6], kAlpha * 75 * kL, 1e-15);
  const auto by_default = Heated(kBar + "TEMP,5,1,50.\nTEMPD,5,90.\n").solve();
  EXPECT_NEAR(by_default.displacement[6], kAlpha * 50 * kL, 1e-15);
}

TEST(ThermalLoads, LoadsAndTemperaturesAdd) {
  const auto s = Heated("LOAD = 9\n" + kBar + "TEMPD,5,120.\nFORCE,9,2,,3500.,1.,0.,0.\n").solve();
  EXPECT_NEAR(s.displacement[6], kAlpha * 100 * kL + 3500 * kL / kEA, 1e-14);
  EXPECT_NEAR(s.elements[0].force(0, 0), 3500, 1e-7);
  EXPECT_NEAR(s.strain_energy, 3500.0 * 3500 * kL / (2 * kEA), 1e-7);
}

TEST(ThermalLoads, WhatIsMissingIsSaid) {
  Heated none(kBar);
  none.make_load();
  ASSERT_EQ(none.diagnostics.num_errors(), 1);
  EXPECT_EQ(none.diagnostics.items().back().id, "fe.missing-load");
  Heated half(kBar + "TEMP,5,1,50.\n");
  half.make_load();
  ASSERT_EQ(half.diagnostics.num_errors(), 1);
  EXPECT_EQ(half.diagnostics.items().back().id, "fe.missing-temperature");
  // What does not expand needs no temperature.
  std::string cold = kBar;
  cold.replace(cold.find("1.2-5"), 5, "0.   ");
  Heated rigid(cold + "TEMP,5,1,50.\n");
  EXPECT_TRUE(rigid.make_load().F.isZero(0));
  EXPECT_EQ(rigid.diagnostics.num_errors(), 0);
}

}  // namespace
}  // namespace bough::fe
