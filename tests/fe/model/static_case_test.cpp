#include "fe/statics/static_case.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fe/linear/petsc.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/statics/build_model.hpp"
#include "formats/nastran/reader.hpp"

namespace bough::fe {
namespace {

using ::testing::HasSubstr;

/// A load case of a deck as `static` solves it.
struct Solved {
  Diagnostics diagnostics;
  records::StaticSubcase result;
};

void solve(const std::string& text, Solved& solved) {
  const auto deck = nastran::read_deck_text(text, "deck.bdf", {}, solved.diagnostics);
  solved.diagnostics.throw_if_errors();
  ModelOptions options;
  options.subcase = deck.subcases[0].id;
  const auto model = build_model(deck, options, solved.diagnostics);
  const auto load = calc_static_load(model, deck, model.subcase(), solved.diagnostics);
  const StaticSolver solver(model, assemble_stiffness(model, DofSet::Free));
  solved.result = solve_static_case(model, solver, load, {}, &solved.diagnostics);
}

/// A cube of one CHEXA, held at z = 0; the grids of z = 1 are 5 to 8.
std::string write_cube(const std::string& load) {
  return "CEND\nSUBCASE 4\nSPC = 1\nLOAD = 3\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\n"
         "GRID,4,,0.,1.,0.\nGRID,5,,0.,0.,1.\nGRID,6,,1.,0.,1.\nGRID,7,,1.,1.,1.\nGRID,8,,0.,1.,1.\n"
         "CHEXA,1,1,1,2,3,4,5,6\n,7,8\nPSOLID,1,1\nMAT1,1,7.+10,,.3\nSPC1,1,123,1,2,3,4\n" +
         load;
}

std::string find(const Diagnostics& diagnostics, const std::string& id) {
  for (const auto& item : diagnostics.items())
    if (item.id == id) return item.what;
  return {};
}

TEST(StaticCase, LoadsOnWhatAutospcHoldsAreNamedLargestFirst) {
  Solved moments;
  solve(write_cube("FORCE,3,7,,8.,1.,0.,0.\nMOMENT,3,6,,5.,0.,0.,1.\nMOMENT,3,8,,-6.,0.,1.,0.\n"), moments);
  EXPECT_EQ(find(moments.diagnostics, "fe.load-autospc"),
            "loads of subcase 4 act on 2 dof(s) without stiffness, which AUTOSPC holds: component 5 of grid 8 (-6), "
            "...");
  EXPECT_GT(moments.result.displacement.norm(), 0);
  Solved force;
  solve(write_cube("FORCE,3,7,,8.,1.,0.,0.\n"), force);
  EXPECT_EQ(find(force.diagnostics, "fe.load-autospc"), "");
  EXPECT_LT((force.result.displacement - moments.result.displacement).norm(), 1e-12 * force.result.displacement.norm());
}

/// Ten stiff rods in a row that hang on a soft spring.
std::string write_hanging(const std::string& spring, const std::string& load) {
  std::string text = "CEND\nSUBCASE 4\nLOAD = 3\nBEGIN BULK\nPARAM,AUTOSPC,NO\nMAT1,1,1.+12,,.3\n";
  for (int i = 1; i <= 11; ++i) {
    text += "GRID," + std::to_string(i) + ",," + std::to_string(0.07 * i + 0.003 * i * i) + ",0.,0.,,23456\n";
    if (i < 11)
      text += "CONROD," + std::to_string(i) + "," + std::to_string(i) + "," + std::to_string(i + 1) + ",1,.3\n";
  }
  return text + "CELAS2,20," + spring + ",1,1\n" + load;
}

// The factor takes it, but no digit of the answer is left: what is said is the motion, not its residual.
TEST(StaticCase, ResidualOfAMotionThatHardlyAnythingHoldsNamesTheMotion) {
  if (linear::initialize_petsc().size > 1) GTEST_SKIP() << "the factor of several processes keeps digits enough";
  Solved hanging;
  try {
    solve(write_hanging(".6", "FORCE,3,11,,1.,1.,0.,0.\n"), hanging);
    ADD_FAILURE() << "solved";
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.items().front().id, "fe.mechanism");
    EXPECT_THAT(error.what(), HasSubstr("component 1"));
  }
  Solved stiffer;
  solve(write_hanging("3.+6", "FORCE,3,11,,1.,1.,0.,0.\n"), stiffer);
  EXPECT_NEAR(stiffer.result.displacement[0], 1 / 3e6, 1e-8 / 3e6);
  Solved balanced;  // the same spring, not strained
  solve(write_hanging(".6", "FORCE,3,11,,1.,1.,0.,0.\nFORCE,3,1,,-1.,1.,0.,0.\n"), balanced);
  const double length = 0.07 * 10 + 0.003 * 120;
  EXPECT_NEAR(balanced.result.displacement[60] - balanced.result.displacement[0], length / 3e11, 1e-6 / 3e11);
}

}  // namespace
}  // namespace bough::fe
