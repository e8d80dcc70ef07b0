/// Structural damping of materials: where every element has the same g, Σ g_e K_e is g K, and a mode has g ω.
#include <gtest/gtest.h>

#include "formats/nastran/reader.hpp"
#include "stiffening/reduce.hpp"

namespace bough {
namespace {

const std::string kPlate =
    "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,2.,.1,0.\nGRID,4,,0.,1.,0.\nGRID,5,,1.,1.2,0.\nGRID,6,,2.,1.,0.\n"
    "CQUAD4,1,1,1,2,5,4\nCQUAD4,2,1,2,3,6,5\nSPC1,1,123456,1,4\n";
const std::string kBox =
    "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nGRID,5,,0.,0.,1.\nGRID,6,,1.,0.,1.\n"
    "GRID,7,,1.,1.,1.\nGRID,8,,0.,1.,1.\nCHEXA,1,1,1,2,3,4,5,6,+\n+,7,8\nSPC1,1,123,1,2,3,4\n";
const std::string kBar =
    "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nCBAR,1,1,1,2,0.,0.,1.\nPBAR,1,1,1.-3,1.-6,2.-6,1.-6\n"
    "CONM2,9,2,,2.\nSPC1,1,123456,1\n";

records::FlexBody reduce(const std::string& control, const std::string& bulk) {
  Diagnostics diagnostics;
  const auto deck =
      nastran::read_deck_text("SOL 103\nCEND\nSPC = 1\n" + control + "BEGIN BULK\n" + bulk, "d.bdf", {}, diagnostics);
  EXPECT_EQ(diagnostics.num_errors(), 0);
  records::BodySpec spec;
  spec.file = "d.toml";
  spec.num_modes = 3;
  spec.has_material_damping = true;
  return stiffening::reduce(deck, spec, {}, diagnostics).body;
}

/// Every mode has g ω and nothing couples them.
void expect_factor(const records::FlexBody& body, double g, const std::string& what) {
  ASSERT_GT(body.num_modes(), 0) << what;
  const Eigen::VectorXd omega = body.eigenvalue.cwiseSqrt();
  const Eigen::MatrixXd expected = (g * omega).asDiagonal();
  EXPECT_LT((body.modal_damping - expected).norm(), 1e-9 * expected.norm()) << what;
}

TEST(MaterialDamping, OfEveryKindOfMaterial) {
  const std::string shell = kPlate + "PSHELL,1,1,.01,1,,1\n";
  expect_factor(reduce("", shell + "MAT1,1,7.+10,,.3,2700.,,,.03\n"), .03, "MAT1 of a PSHELL");
  expect_factor(reduce("", shell + "MAT2,1,7.+10,2.+10,,7.+10,,2.5+10,2700.,+\n+,,,,,.04\n"), .04, "MAT2");
  expect_factor(reduce("", shell + "MAT8,1,7.+10,3.+10,.3,2.+10,2.+10,1.+10,2700.,+\n+,,,,,,,,,+\n+,.05\n"), .05,
                "MAT8");
  // MID1's for the whole of a PSHELL; a laminate's own, not its plies'.
  expect_factor(reduce("", kPlate + "PSHELL,1,1,.01,2,,2\nMAT1,1,7.+10,,.3,2700.,,,.03\nMAT1,2,7.+10,,.3,,,,.5\n"), .03,
                "MID1");
  expect_factor(reduce("", kPlate + "PCOMP,1,,,,,,.06,,+\n+,1,.004,0.,,1,.006,30.\n"
                                    "MAT8,1,7.+10,3.+10,.3,2.+10,2.+10,1.+10,2700.,+\n+,,,,,,,,,+\n+,.5\n"),
                .06, "PCOMP");
  const std::string solid = kBox + "PSOLID,1,1\n";
  expect_factor(reduce("", solid + "MAT1,1,7.+10,,.3,2700.,,,.03\n"), .03, "MAT1 of a solid");
  expect_factor(reduce("", solid + "MAT9,1,1.+11,4.+10,4.+10,,,,1.+11,+\n+,4.+10,,,,1.+11,,,,+\n"
                                   "+,3.+10,,,3.+10,,3.+10,2700.,,+\n+,,,,,,,.07\n"),
                .07, "MAT9");
  expect_factor(reduce("", kBar + "MAT1,1,7.+10,,.3,,,,.02\nPARAM,G,.01\n"), .03, "a bar with PARAM,G");
}

/// Stiffness that is given is scaled by PARAM,G as that of the elements; a bush has one GE a direction.
TEST(MaterialDamping, OfGivenMatricesAndBushes) {
  const std::string bar = "MAT1,1,7.+10,,.3\nPARAM,G,4.-2\n";
  expect_factor(reduce("K2GG = KA\n", kBar + bar + "DMIG,KA,0,6,1\nDMIG,KA,2,1,,2,1,5.+6,,+\n+,2,3,7.+4\n"), .04,
                "K2GG");
  expect_factor(reduce("", kBar + bar + "CBUSH,8,8,2,,,,,0\nPBUSH,8,K,1.+6,2.+6,3.+6\n"), .04, "PBUSH without GE");
  const std::string bush = "GRID,1,,0.,0.,0.\nCONM2,9,1,,2.,,,,,+\n+,1.,,1.,,,1.\nCBUSH,8,8,1,,,,,0\nSPC1,1,456,1\n";
  const auto body = reduce("", bush + "PBUSH,8,K,1.+6,4.+6,9.+6,,,,+\n+,,GE,.1,.2,.3\n");
  ASSERT_EQ(body.num_modes(), 3);
  for (int j = 0; j < 3; ++j)
    EXPECT_NEAR(body.modal_damping(j, j) / std::sqrt(body.eigenvalue(j)), .1 * (j + 1), 1e-12);
}

/// Dofs that ASET leaves out condense in the deck, not in a copy of it with other moduli.
TEST(MaterialDamping, OfACondensedModel) {
  const std::string two =
      "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,2.,0.,0.\nCBAR,1,1,1,2,0.,0.,1.\nCBAR,2,1,2,3,0.,0.,1.\n"
      "PBAR,1,1,1.-3,1.-6,2.-6,1.-6\nCONM2,9,3,,2.\nSPC1,1,123456,1\nASET1,123,3\nMAT1,1,7.+10,,.3,,,,.02\n";
  expect_factor(reduce("", two), .02, "ASET");
}

}  // namespace
}  // namespace bough
