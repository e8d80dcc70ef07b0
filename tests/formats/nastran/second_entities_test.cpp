/// \file Two elements or properties on one card, and data where a card has no field.
#include "tests/formats/nastran/deck_text.hpp"

namespace bough::nastran {
namespace {

TEST(SecondEntities, AreTaken) {
  const auto deck = read_clean(
      "CROD,1,1,1,2,2,,2,3\n"
      "CTUBE,1,1,1,2,2,1,2,3\n"
      "CELAS3,1,1,1,0,2,1,1,2\n"
      "CELAS4,3,100.,1,0,4,200.,1,2\n"
      "CMASS3,1,1,1,0,2,1,1,2\n"
      "CMASS4,3,1.5,1,0,4,2.5,3\n"
      "CDAMP3,1,1,1,0,2,1,1,2\n"
      "CDAMP4,3,1.5,1,0,4,2.5,1,2\n"
      "CVISC,1,1,1,2,2,1,2,3\n"
      "CRIGDR,1,1,2,3,2,1,3,2\n"
      "PSHEAR,1,1,.1,.5,2,1,.2\n"
      "PSHEAR,3,1,.1,.5,.25,.75\n");
  ASSERT_EQ(deck.crod.size(), 2u);
  EXPECT_EQ(deck.crod[1].pid, 2);  // blank: its own EID
  EXPECT_EQ(deck.crod[1].gb, 3);
  EXPECT_EQ(deck.ctube.size(), 2u);
  ASSERT_EQ(deck.springs.size(), 4u);
  EXPECT_EQ(values(deck.springs[3].k, deck.springs[3].g2), values(200.0, 2));
  ASSERT_EQ(deck.scalar_masses.size(), 4u);
  EXPECT_EQ(values(deck.scalar_masses[3].m, deck.scalar_masses[3].g1), values(2.5, 3));
  ASSERT_EQ(deck.dampers.size(), 4u);
  EXPECT_EQ(deck.dampers[3].b, 2.5);
  EXPECT_EQ(deck.cvisc.size(), 2u);
  ASSERT_EQ(deck.rrod.size(), 2u);
  EXPECT_EQ(deck.rrod[1].cmb, 2);
  ASSERT_EQ(deck.pshear.size(), 3u);
  EXPECT_EQ(deck.pshear[1].t, .2);
  EXPECT_EQ(deck.pshear[2].f2, .75);
}

TEST(SecondEntities, AreCheckedLikeTheFirst) {
  EXPECT_EQ(values(read("CROD,1,1,1,2,1,1,2,3\n").count("deck.duplicate-id"),
                   read("CROD,1,1,1,2,2,1,x,3\n").count("deck.bad-integer"),
                   read("CELAS4,1,1.,1,2,3,5.\n").count("deck.missing-field")),
            values(1, 1, 1));
}

TEST(Leftovers, AreNamedWithTheirFieldAndCount) {
  const auto r = read(
      "CROD,1,1,1,2\n+,,,junk,55\n"
      "CROD,2,1,1,2\n+,,,more\n"
      "MAT1,1,1.+7,,.3\n+,1.,2.,3.,4,5,6\n"
      "CELAS2,9,100.,1,2,2,2,.01,1.\n+,7\n"
      "GRID,1,,0.,0.,0.,,345,0\n");
  EXPECT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
  ASSERT_EQ(r.count("deck.unused-field"), 3) << r.get_messages();
  const auto& items = r.diagnostics.items();
  EXPECT_EQ(items[0].where.line, 8);  // CELAS2: by name
  EXPECT_NE(items[1].what.find("CROD: field 4 of line 2 'junk' is not used (2 cards"), std::string::npos)
      << items[1].what;
  EXPECT_EQ(items[1].where.line, 2);
  EXPECT_NE(items[2].what.find("MAT1: field 6 of line 2 '5'"), std::string::npos) << items[2].what;
}

TEST(Leftovers, FieldsThatCardsHaveAndZerosAreNone) {
  read_clean(
      "GRID,1,,0.,0.,0.,,,5\n"
      "PSHELL,1,1,.1,1,,1,,,\n+,-.05,.05\n"
      "PSOLID,2,1,0,TWO,GRID,FULL,SMECH\n"
      "PBUSH,3,K,1.,1.,1.,1.,1.,1.\n+,,RCV,1.,1.,1.,1.\n"
      "MAT8,8,1.+7,1.+6,.3,1.+6,,,1.\n+,,,,100.,100.,100.,100.,100.\n+,.01,0.,1.\n"
      "RBE2,4,1,123,2,3,1.-5\n"
      "RBE3,5,,1,123,1.,123,2,3\n+,UM,1,123,,,,,,+\n+,ALPHA,1.-5,20.\n"
      "RBAR,6,1,2,123456,,,,1.-5\n"
      "RFORCE,1,1,,1.,0.,0.,1.,2\n+,0.,-1\n"
      "PLOAD4,1,9,1.,,,,1,3\n+,,0.,0.,1.,SURF,NORM\n"
      "EIGRL,1,,,10,0,7,,MASS\n"
      "CROD,7,1,1,2,,,,\n+,0,0.0\n");
}

TEST(Replication, CountsFromZeroOnABlankField) {
  // The increment is an integer, so the field becomes one: CD = 1, not 1.0.
  const auto deck = read_clean("GRID,1,,0.,0.,0.\n=,*(1),=,*(1.),=,=,*(1)\n=(1)\n");
  ASSERT_EQ(deck.grids.size(), 3u);
  EXPECT_EQ(values(deck.grids[1].cd, deck.grids[2].cd, deck.grids[2].x.x()), values(1, 2, 2.0));
}

}  // namespace
}  // namespace bough::nastran
