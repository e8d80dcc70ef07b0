/// \file Load cards beyond FORCE and GRAV: fields, defaults, ranges, and what is wrong with them.
#include "tests/formats/nastran/deck_text.hpp"

namespace bough::nastran {
namespace {

using Eigen::Vector3d;

TEST(LoadCards, DirectedAndScalar) {
  const auto r = read(
      "FORCE1,1,2,3.,4,5\nMOMENT1,1,2,3.,4,5\nFORCE2,1,2,3.,4,5,6,7\nMOMENT2,1,2,,4,5,6,7\n"
      "SLOAD,3,11,1.5,12,-2.\nSPCD,4,1,12,.1,2,3,.2\n");
  ASSERT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
  const auto& c = r.deck.load_cards;
  ASSERT_EQ(c.directed.size(), 4u);
  EXPECT_FALSE(c.directed[0].is_cross);
  EXPECT_TRUE(c.directed[1].is_moment);
  EXPECT_TRUE(c.directed[3].is_cross && c.directed[3].is_moment);
  EXPECT_EQ(c.directed[2].grids, (std::array<int, 4>{4, 5, 6, 7}));
  EXPECT_EQ(c.directed[0].grids, (std::array<int, 4>{4, 5, 0, 0}));
  ASSERT_EQ(c.scalar.size(), 2u);
  EXPECT_EQ(c.scalar[1].f, -2);
  ASSERT_EQ(c.spcd.size(), 2u);
  EXPECT_EQ(c.spcd[0].c, 3u);
  EXPECT_EQ(c.spcd[1].g, 2);
}

TEST(LoadCards, LinesAlongBeams) {
  const auto r = read("PLOAD1,1,9,FYE,FRPR,.1,2.,.9\nPLOAD1,1,9,MZ,LE,,4.\n");
  ASSERT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
  const auto& b = r.deck.load_cards.beams;
  ASSERT_EQ(b.size(), 2u);
  EXPECT_TRUE(b[0].in_element_axes && b[0].is_fraction && b[0].is_projected && !b[0].is_moment);
  EXPECT_EQ(b[0].axis, 1);
  EXPECT_EQ(b[0].p2, 0);  // blank: not P1
  EXPECT_FALSE(b[1].x2.has_value());
  EXPECT_TRUE(b[1].is_moment && !b[1].is_fraction && !b[1].in_element_axes);
  EXPECT_EQ(b[1].axis, 2);
}

TEST(LoadCards, Pressures) {
  const auto r = read(
      "PLOAD,1,2.,1,2,3\nPLOAD2,1,2.,5,6\nPLOAD2,1,2.,11,THRU,13\nPLOAD4,2,7,3.,,5.\n"
      "PLOAD4,3,8,1.,2.,3.,4.,31,33\n,9,0.,0.,2.\nPLOAD4,4,1,1.,,,,THRU,3\n");
  ASSERT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
  EXPECT_EQ(r.deck.load_cards.grid_pressures[0].grids, (std::vector<int>{1, 2, 3}));
  const auto& p = r.deck.load_cards.pressures;
  ASSERT_EQ(p.size(), 2u + 3u + 1u + 1u + 3u);
  EXPECT_EQ(p[4].element, 13);
  EXPECT_TRUE(p[4].skip_if_missing && !p[0].skip_if_missing);
  EXPECT_EQ(values(p[5].p, p[6].g1, p[6].g34), values((std::array<double, 4>{3, 3, 5, 3}), 31, 33));
  EXPECT_EQ(values(p[6].cid, *p[6].n, p[9].element), values(9, Vector3d(0, 0, 2), 3));
}

TEST(LoadCards, Rotation) {
  const auto r = read("RFORCE,1,2,3,.5,0.,0.,2.,2\n,7.\n");
  ASSERT_EQ(r.diagnostics.num_errors(), 0) << r.get_messages();
  const auto& f = r.deck.load_cards.rotations.at(0);
  EXPECT_EQ(values(f.g, f.cid, f.a, f.r, f.racc), values(2, 3, 0.5, Vector3d(0, 0, 2), 7));
}

TEST(LoadCards, WhatIsWrongIsSaid) {
  EXPECT_EQ(values(read("PLOAD1,1,9,FQ,LE,0.,1.\n").count("deck.bad-word"),
                   read("PLOAD1,1,9,FX,,0.,1.\n").count("deck.missing-field"),
                   read("PLOAD1,1,9,FX,LE,2.,1.,1.,1.\n").count("deck.field-range")),
            values(1, 1, 1));
  EXPECT_EQ(
      values(read("PLOAD2,1,2.\n").count("deck.missing-field"), read("PLOAD2,1,2.,9,THRU,3\n").count("deck.bad-list"),
             read("PLOAD4,1,2,3.\n,,,,,LINE\n").count("deck.bad-word")),
      values(1, 1, 1));
  EXPECT_EQ(read("RFORCE,1,,,2.\n").count("deck.field-range"), 1);
}

}  // namespace
}  // namespace bough::nastran
