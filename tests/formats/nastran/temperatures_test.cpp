/// \file TEMP, TEMPD, TEMPRB, TEMPP1, their selection, and the expansion of materials.
#include "tests/formats/nastran/deck_text.hpp"

namespace bough::nastran {
namespace {

TEST(Temperatures, Cards) {
  const auto t = read_clean(
                     "TEMP,5,1,20.,2,30.\nTEMPD,5,10.,6,11.\n"
                     "TEMPRB,5,12,21.,23.,2.,3.,-4.,-5.,+A\n+A,1.,1.,1.,1.,1.,1.,1.,1.,+B\n+B,14,THRU,16\n"
                     "TEMPP1,5,101,40.,.5,1.,2.,,,+C\n+C,103,105\n")
                     .temperatures;
  ASSERT_EQ(t.grids.size(), 2u);
  EXPECT_EQ(t.grids[1].g, 2);
  EXPECT_EQ(t.grids[1].t, 30);
  ASSERT_EQ(t.defaults.size(), 2u);
  EXPECT_EQ(t.defaults[1].sid, 6);
  ASSERT_EQ(t.bars.size(), 4u);
  EXPECT_EQ(values(t.bars[0].element, t.bars[3].element, t.bars[3].t_b), values(12, 16, 23));
  EXPECT_EQ(values(t.bars[3].gradient_a, t.bars[3].gradient_b), values(Eigen::Vector2d(2, -4), Eigen::Vector2d(3, -5)));
  ASSERT_EQ(t.plates.size(), 3u);
  EXPECT_EQ(t.plates[2].element, 105);
  EXPECT_EQ(t.plates[2].gradient, 0.5);
}

TEST(Temperatures, Errors) {
  EXPECT_EQ(values(read("TEMP,5\n").count("deck.missing-field"), read("TEMP,5,1,hot\n").count("deck.bad-real"),
                   read("TEMPD,5,1.\nTEMPD,5,2.\n").count("deck.duplicate-id")),
            values(1, 1, 1));
  EXPECT_EQ(read("TEMPD\n").count("deck.missing-field"), 1);
}

TEST(Temperatures, SelectionInTheCaseControl) {
  const auto r = read(
      "SOL 101\nCEND\nTEMP(INIT) = 3\nSUBCASE 1\nTEMPERATURE(LOAD) = 7\nSUBCASE 2\nTEMP = 8\nSUBCASE 3\nTEMP(MATE) = "
      "9\nBEGIN BULK\n");
  ASSERT_EQ(r.deck.subcases.size(), 3u) << r.get_messages();
  EXPECT_EQ(values(r.deck.subcases[0].temperature, r.deck.subcases[1].temperature, r.deck.subcases[2].temperature),
            values(7, 8, 0));
  EXPECT_EQ(r.deck.subcases[2].initial_temperature, 3);
  const bool has_materials[] = {false, true, true};
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(r.deck.subcases[i].commands.count("TEMPERATURE(MATERIAL)") > 0, has_materials[i]) << i;
}

TEST(Temperatures, ExpansionOfMaterials) {
  const auto deck = read_clean(
      "MAT2,1,1.,0.,0.,1.,0.,1.,.1,+\n+,1.-5,2.-5,3.-5,20.\nMAT8,2,2.,1.,.3,1.,,,.1,+\n+,.7-6,31.-6,30.\n"
      "MAT9,3,1.,,,,,,1.,+\n+,,,,,1.,,,,+\n+,1.,,,1.,,1.,.1,1.-5,+\n+,2.-5,3.-5,4.-5,5.-5,6.-5,25.\n"
      "PCOMP,7,,,,,35.,,SYM,+\n+,2,.1\n");
  EXPECT_EQ(values(deck.mat2[0].alpha, deck.mat2[0].tref, deck.mat8[0].a2),
            values(Eigen::Vector3d(1e-5, 2e-5, 3e-5), 20, 31e-6));
  EXPECT_EQ(values(deck.mat8[0].tref, deck.mat9[0].rho, deck.mat9[0].alpha[5]), values(30, 0.1, 6e-5));
  EXPECT_EQ(values(deck.mat9[0].tref, deck.pcomp[0].tref), values(25, 35));
  EXPECT_FALSE(read_clean("MAT1,1,1.,,.3,1.,1.-5\n").mat1[0].tref);
}

}  // namespace
}  // namespace bough::nastran
