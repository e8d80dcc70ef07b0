/// \file TEMP, TEMPD, TEMPRB, TEMPP1, their selection, and the expansion of materials.
#include "tests/formats/nastran/deck_text.hpp"

namespace bough::nastran {
namespace {

TEST(Temperatures, Cards) {
  const auto deck = read_clean(
      "TEMP,5,1,20.,2,30.\nTEMPD,5,10.,6,11.\n"
      "TEMPRB,5,12,21.,23.,2.,3.,-4.,-5.,+A\n+A,1.,1.,1.,1.,1.,1.,1.,1.,+B\n+B,14,THRU,16\n"
      "TEMPP1,5,101,40.,.5,1.,2.,,,+C\n+C,103,105\n");
  const auto& t = deck.temperatures;
  ASSERT_EQ(t.grids.size(), 2u);
  EXPECT_EQ(t.grids[1].g, 2);
  EXPECT_EQ(t.grids[1].t, 30);
  ASSERT_EQ(t.defaults.size(), 2u);
  EXPECT_EQ(t.defaults[1].sid, 6);
  ASSERT_EQ(t.bars.size(), 4u);
  EXPECT_EQ(t.bars[0].element, 12);
  EXPECT_EQ(t.bars[3].element, 16);
  EXPECT_EQ(t.bars[3].t_b, 23);
  EXPECT_EQ(t.bars[3].gradient_a, Eigen::Vector2d(2, -4));
  EXPECT_EQ(t.bars[3].gradient_b, Eigen::Vector2d(3, -5));
  ASSERT_EQ(t.plates.size(), 3u);
  EXPECT_EQ(t.plates[2].element, 105);
  EXPECT_EQ(t.plates[2].gradient, 0.5);
}

TEST(Temperatures, Errors) {
  EXPECT_EQ(read("TEMP,5\n").count("deck.missing-field"), 1);
  EXPECT_EQ(read("TEMP,5,1,hot\n").count("deck.bad-real"), 1);
  EXPECT_EQ(read("TEMPD,5,1.\nTEMPD,5,2.\n").count("deck.duplicate-id"), 1);
  EXPECT_EQ(read("TEMPD\n").count("deck.missing-field"), 1);
}

TEST(Temperatures, SelectionInTheCaseControl) {
  const auto r = read(
      "SOL 101\nCEND\nTEMP(INIT) = 3\nSUBCASE 1\nTEMPERATURE(LOAD) = 7\nSUBCASE 2\nTEMP = 8\nSUBCASE 3\nTEMP(MATE) = "
      "9\nBEGIN BULK\n");
  ASSERT_EQ(r.deck.subcases.size(), 3u) << r.get_messages();
  EXPECT_EQ(r.deck.subcases[0].temperature, 7);
  EXPECT_EQ(r.deck.subcases[1].temperature, 8);
  EXPECT_EQ(r.deck.subcases[2].temperature, 0);
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
  EXPECT_EQ(deck.mat2[0].alpha, Eigen::Vector3d(1e-5, 2e-5, 3e-5));
  EXPECT_EQ(deck.mat2[0].tref, 20);
  EXPECT_EQ(deck.mat8[0].a2, 31e-6);
  EXPECT_EQ(deck.mat8[0].tref, 30);
  EXPECT_EQ(deck.mat9[0].rho, 0.1);
  EXPECT_EQ(deck.mat9[0].alpha[5], 6e-5);
  EXPECT_EQ(deck.mat9[0].tref, 25);
  EXPECT_EQ(deck.pcomp[0].tref, 35);
  EXPECT_FALSE(read_clean("MAT1,1,1.,,.3,1.,1.-5\n").mat1[0].tref);
}

}  // namespace
}  // namespace bough::nastran
