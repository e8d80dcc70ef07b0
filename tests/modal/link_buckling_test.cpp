/// Buckling of columns that end in rigid levers.
#include <gtest/gtest.h>

#include "fe/loads/wide_links.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/static_case.hpp"
#include "formats/nastran/reader.hpp"
#include "modal/eigen.hpp"

namespace bough {
namespace {

/// EI = 1, the lower half of length 1 flexible, the upper half the given lever from grid 21 to grid 100.
double calc_factor(const std::string& lever, const std::string& selection = "") {
  std::string text =
      selection + "SPC = 1\nLOAD = 2\nBEGIN BULK\nMAT1,1,1.,,0.,1.\nPBAR,1,1,1.+4,1.,2.,1.\nSPC1,1,123456,1\n";
  for (int i = 1; i <= 21; ++i) {
    text += "GRID," + std::to_string(i) + ",," + std::to_string(0.05 * (i - 1)) + ",0.,0.\n";
    if (i > 1)
      text += "CBAR," + std::to_string(i) + ",1," + std::to_string(i - 1) + "," + std::to_string(i) + ",0.,1.,0.\n";
  }
  text += "GRID,100,,2.,0.,0.\nFORCE,2,100,0,1.,-1.,0.,0.\n" + lever;
  Diagnostics diagnostics;
  const auto deck = nastran::read_deck_text(text, "deck.bdf", {}, diagnostics);
  diagnostics.throw_if_errors();
  const auto model = fe::build_model(deck, {}, diagnostics);
  const auto load = fe::calc_static_load(model, deck, -1, diagnostics);
  const fe::StaticSolver solver(model, fe::assemble_stiffness(model, fe::DofSet::Free));
  const auto u = fe::solve_static_case(model, solver, load).displacement;
  modal::EigenOptions options;
  options.num_modes = 1;
  return modal::calc_buckling_modes(model, load, u, options, diagnostics).lambda[0];
}

// The tip's push P on the lever of length 1: x tan x = 1 with x² = P.
TEST(LinkBuckling, ColumnWithARigidUpperHalf) {
  const double expected = 0.860333589 * 0.860333589;
  const std::string levers[] = {
      "RBE2,200,21,123456,100\n",
      "RBAR,200,21,100,123456,,,123456\n",
      "RBAR,200,21,100,12346,5,5,12346\n",
      "RBAR1,200,21,100,123456\n",
      "RBE1,200,21,123456\n,UM,100,123456\n",
      "RBE3,200,,100,123456,1.,123456,21\n",
      "GRID,99,,1.5,0.,0.\nRBE2,200,21,123456,99\nRBE2,201,99,123456,100\n",
      "GRID,99,,1.4,.3,0.\nRBE2,200,21,123456,99\nRBE2,201,99,123456,100\n",
      "GRID,98,,1.,.4,0.\nGRID,99,,1.,-.4,.3\nRTRPLT,200,21,98,99,123456\n,,123456,123456\n"
      "RBE2,201,98,123456,100\n",
      "PBAR,2,1,1.+6,1.+6,1.+6,1.+6\nCBAR,200,2,21,100,0.,1.,0.\n",
  };
  for (const auto& lever : levers) EXPECT_NEAR(calc_factor(lever) / expected, 1, 1e-4) << lever;
}

// The second order of a mean over very many grids would fill K_G: it is left out, and the card is named.
TEST(LinkBuckling, WideLinksAreNamed) {
  std::string text = "BEGIN BULK\nGRID,9001,,0.,0.,0.\n";
  for (const int num : {1001, 999}) {
    text += "RBE3," + std::to_string(num) + ",,9001,123456,1.,123";
    for (int i = 1; i <= num; ++i) text += (i > 2 && i % 8 == 3 ? "\n," : ",") + std::to_string(i);
    text += "\n";
  }
  for (int i = 1; i <= 1001; ++i) text += "GRID," + std::to_string(i) + ",,1.,0.,0.\n";
  Diagnostics diagnostics;
  const auto deck = nastran::read_deck_text(text, "deck.bdf", {}, diagnostics);
  fe::report_wide_links(deck, diagnostics);
  ASSERT_EQ(diagnostics.items().size(), 1u);
  EXPECT_EQ(diagnostics.items()[0].id, "fe.wide-link");
  EXPECT_EQ(diagnostics.items()[0].where.line, 3);
}

// The lever as equations: its end goes along a straight line, and the push finds no lever.
TEST(LinkBuckling, UserEquationsStayLinear) {
  const double straight = calc_factor(
      "MPC,8,100,1,-1.,21,1,1.\nMPC,8,100,2,-1.,21,2,1.\n,,21,6,1.\nMPC,8,100,3,-1.,21,3,1.\n,,21,5,-1.\n"
      "SPC1,1,456,100\n",
      "MPC = 8\n");
  EXPECT_GT(straight, 2.4);
}

}  // namespace
}  // namespace bough
